// SPDX-License-Identifier: BSD-3-Clause
// Writing of .npz files: ZIP archives of NumPy arrays.
#include "NumpyArchive.h"

#include <csom/core/Error.h>
#include <csom/io/OutputFile.h>
#include <zip.h>

#include <cstdint>
#include <memory>
#include <utility>

#include <csom/exports/ExportChecks.h>
#include "BinaryNumbers.h"

namespace csom::detail {
namespace {

struct Discard {
  void operator()(zip_t* archive) const { zip_discard(archive); }
};

std::string zipErrorText(int code) {
  zip_error_t error;
  zip_error_init_with_code(&error, code);
  std::string text = zip_error_strerror(&error);
  zip_error_fini(&error);
  return text;
}

void addToArchive(zip_t* archive, const NumpyArray& array, const std::string& target) {
  // Equal arrays, equal bytes: the files' times do not go along.
  constexpr std::uint16_t kMidnight = 0;
  constexpr std::uint16_t kFirstOfJanuary1980 = (1U << 5U) | 1U;
  constexpr zip_int64_t kWholeFile = -1;
  zip_source_t* source = zip_source_file(archive, array.file().c_str(), 0, kWholeFile);
  const zip_int64_t index =
      source == nullptr
          ? -1
          : zip_file_add(archive, (array.name() + ".npy").c_str(), source, ZIP_FL_ENC_UTF_8);
  if (index < 0) {
    const std::string reason = zip_strerror(archive);
    zip_source_free(source);
    throw FileError(target, "cannot be written: " + reason);
  }
  // The lowest level is five times as fast as the usual one, for files a little larger.
  constexpr zip_uint32_t kFastest = 1;
  if (zip_set_file_compression(archive, static_cast<zip_uint64_t>(index), ZIP_CM_DEFLATE,
                               kFastest) != 0)
    throw FileError(target, std::string("cannot be written: ") + zip_strerror(archive));
  if (zip_file_set_dostime(archive, static_cast<zip_uint64_t>(index), kMidnight,
                           kFirstOfJanuary1980, 0) != 0)
    throw FileError(target, std::string("cannot be written: ") + zip_strerror(archive));
}

}  // namespace

NumpyArray::NumpyArray(std::string name, const std::string& file, const std::string& type,
                       const std::string& shape)
    : name_(std::move(name)), file_(file), stream_(file, std::ios::binary) {
  std::string header =
      "{'descr': '" + type + "', 'fortran_order': False, 'shape': " + shape + ", }";
  constexpr std::size_t kPreamble = 10;
  constexpr std::size_t kAlignment = 64;
  while ((kPreamble + header.size() + 1) % kAlignment != 0) header += ' ';
  header += '\n';
  constexpr char kMagic[] = "\x93NUMPY\x01";
  write(kMagic, sizeof kMagic);  // the terminating zero is the minor version
  writeBinary(*this, static_cast<std::uint16_t>(header.size()));
  write(header.data(), header.size());
}

void NumpyArray::write(const void* bytes, std::size_t size) {
  if (!stream_.write(static_cast<const char*>(bytes), static_cast<std::streamsize>(size)))
    throw FileError(file_, "cannot be written; set TMPDIR to a place with more room");
}

void NumpyArray::close() {
  stream_.close();
  if (!stream_) throw FileError(file_, "cannot be written; set TMPDIR to a place with more room");
}

NumpyArray& NumpyArchive::add(const std::string& name, const std::string& type,
                              const std::string& shape) {
  return arrays_.emplace_back(name, folder_.file(name + ".npy"), type, shape);
}

void NumpyArchive::write(const std::string& target) {
  OutputFile out(target);
  requireRegularFile(out, target);
  for (NumpyArray& array : arrays_) array.close();

  int code = 0;
  std::unique_ptr<zip_t, Discard> archive(
      zip_open(out.path().c_str(), ZIP_CREATE | ZIP_TRUNCATE, &code));
  if (!archive) throw FileError(target, "cannot be written: " + zipErrorText(code));
  for (const NumpyArray& array : arrays_) addToArchive(archive.get(), array, target);
  // Reads and packs the arrays; frees the archive only if that went well.
  if (zip_close(archive.get()) != 0)
    throw FileError(target, std::string("cannot be written: ") + zip_strerror(archive.get()));
  (void)archive.release();
  out.commit();
}

}  // namespace csom::detail
