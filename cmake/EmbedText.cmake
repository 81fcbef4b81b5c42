# SPDX-License-Identifier: BSD-3-Clause
# cmake -DINPUT=file.js -DOUTPUT=file.cpp -DNAME=kScript -P EmbedText.cmake: a text file as the
# definition of a csom::WebAsset.
file(READ ${INPUT} text)
file(SHA256 ${INPUT} sha256)
set(quote embedded_text)
string(FIND "${text}" ")${quote}\"" ends_early)
if(text STREQUAL "" OR NOT ends_early EQUAL -1)
  message(FATAL_ERROR "${INPUT}: is empty or contains )${quote}\", which ends a string of C++")
endif()
file(WRITE ${OUTPUT} "// Made of ${INPUT} by the build.
#include \"WebAsset.h\"
const csom::WebAsset csom::${NAME}{R\"${quote}(")
file(APPEND ${OUTPUT} "${text}")
file(APPEND ${OUTPUT} ")${quote}\", \"${sha256}\"};\n")
