// SPDX-License-Identifier: BSD-3-Clause
#include "WebAsset.h"

#include <csom/report/Html.h>

#include <cstdint>
#include <vector>

namespace csom {

std::string scriptElement(const WebAsset& script) {
  return "<script>" + std::string(script.text) + "</script>\n";
}

std::string policySource(const WebAsset& script) {
  std::vector<std::uint8_t> digest;
  for (std::size_t i = 0; i < script.sha256.size(); i += 2)
    digest.push_back(
        static_cast<std::uint8_t>(std::stoi(std::string(script.sha256.substr(i, 2)), nullptr, 16)));
  return "'sha256-" + encodeBase64(digest) + "'";
}

}  // namespace csom
