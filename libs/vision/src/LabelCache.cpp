// SPDX-License-Identifier: BSD-3-Clause
// PNG files named by what they were made from.
#include <csom/core/Error.h>
#include <csom/core/TemporaryPath.h>
#include <csom/vision/LabelCache.h>
#include <fcntl.h>
#include <unistd.h>
#include <xxhash.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <optional>
#include <stdexcept>
#include <type_traits>

#include "NetworkOutput.h"

namespace csom {
namespace {

namespace fs = std::filesystem;

/// To be changed with the meaning of the files: files of other versions are not found.
constexpr int kFormat = 2;

constexpr std::size_t kSealSize = 32;

/// XXH3, 128 bits, over a sequence of pieces.
class Hasher {
 public:
  Hasher() : state_(XXH3_createState(), &XXH3_freeState) {
    if (!state_) throw std::bad_alloc();
    XXH3_128bits_reset(state_.get());
  }
  Hasher& bytes(const void* bytes, std::size_t size) {
    XXH3_128bits_update(state_.get(), bytes, size);
    return *this;
  }
  template <class Number>
  Hasher& number(Number number) {
    static_assert(std::is_arithmetic_v<Number> || std::is_enum_v<Number>);
    return bytes(&number, sizeof number);
  }
  Hasher& text(const std::string& text) {
    return number(text.size()).bytes(text.data(), text.size());
  }
  /// 32 hexadecimal digits.
  std::string digits() const {
    const XXH128_hash_t hash = XXH3_128bits_digest(state_.get());
    char digits[33];
    std::snprintf(digits, sizeof digits, "%016llx%016llx",
                  static_cast<unsigned long long>(hash.high64),
                  static_cast<unsigned long long>(hash.low64));
    return digits;
  }

 private:
  std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state_;
};

/// Nothing if the file cannot be read.
std::optional<std::vector<std::uint8_t>> bytesOf(const std::string& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return std::nullopt;
  std::ifstream stream(file, std::ios::binary | std::ios::ate);
  const std::streamoff size = stream.tellg();
  if (!stream || size < 0) return std::nullopt;
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(size));
  stream.seekg(0);
  if (!stream.read(reinterpret_cast<char*>(bytes.data()), size)) return std::nullopt;
  return bytes;
}

/// Stands behind the PNG, where no decoder looks: a file that was changed, or that has come under
/// the name of another image, is not believed.
std::string computeSeal(const std::string& key, const std::uint8_t* png, std::size_t size) {
  return Hasher().text(key).bytes(png, size).digits();
}

/// The file appears complete or not at all. It is not flushed to the disk: what a power failure
/// damages is made anew.
void writeAtOnce(const std::string& file, const std::vector<std::uint8_t>& bytes) {
  const auto fail = [&file] {
    throw FileError(file, std::string("cannot be written: ") + std::strerror(errno));
  };
  std::string beside;
  std::unique_ptr<TemporaryPath> temporary;
  int descriptor = -1;
  for (int attempt = 0; descriptor < 0; ++attempt) {
    beside = file + ".tmp" + std::to_string(::getpid()) + "-" + std::to_string(attempt);
    temporary = std::make_unique<TemporaryPath>(beside);
    descriptor = ::open(beside.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
    if (descriptor < 0 && errno != EEXIST) fail();
  }
  std::FILE* stream = ::fdopen(descriptor, "wb");
  bool done =
      stream != nullptr && std::fwrite(bytes.data(), 1, bytes.size(), stream) == bytes.size();
  if (stream != nullptr) done = std::fclose(stream) == 0 && done;
  if (done && std::rename(beside.c_str(), file.c_str()) == 0) return;
  const int reason = errno;
  ::unlink(beside.c_str());
  errno = reason;
  fail();
}

/// Of everything that decides on what a network says about an image.
std::string computeHash(const NetworkDescription& network) {
  Hasher hasher;
  hasher.number(kFormat);
  for (const std::string& file : {network.model, network.config}) {
    if (file.empty()) continue;
    const auto bytes = bytesOf(file);
    if (!bytes) throw FileError(file, "cannot be read; a model of a network is expected");
    hasher.number(bytes->size()).bytes(bytes->data(), bytes->size());
  }
  hasher.number(network.width).number(network.height).number(network.resize);
  hasher.number(network.channels).number(network.scale);
  for (const double mean : network.mean) hasher.number(mean);
  for (const double deviation : network.deviation) hasher.number(deviation);
  hasher.text(network.output_name).number(network.output).number(network.output_channels);
  return hasher.digits();
}

}  // namespace

LabelCache::LabelCache(std::string folder, const NetworkDescription& description)
    : folder_(std::move(folder)),
      description_(description),
      network_hash_(computeHash(description)) {
  std::error_code error;
  fs::create_directories(folder_, error);
  if (!fs::is_directory(folder_)) throw FileError(folder_, "cannot be made a folder for labels");
}

std::string LabelCache::keyOf(const cv::Mat& image) const {
  Hasher hasher;
  hasher.text(network_hash_).number(image.type()).number(image.rows).number(image.cols);
  const std::size_t row_size = static_cast<std::size_t>(image.cols) * image.elemSize();
  for (int row = 0; row < image.rows; ++row) hasher.bytes(image.ptr(row), row_size);
  return hasher.digits();
}

std::string LabelCache::fileOf(const std::string& key) const {
  return (fs::path(folder_) / (key + ".png")).string();
}

std::shared_ptr<const SemanticImage> LabelCache::find(const cv::Mat& image,
                                                      const RawToClass& class_of) const {
  const std::string key = keyOf(image);
  auto bytes = bytesOf(fileOf(key));
  if (!bytes || bytes->size() <= kSealSize) return nullptr;
  const std::size_t size = bytes->size() - kSealSize;
  const std::string seal = computeSeal(key, bytes->data(), size);
  if (!std::equal(seal.begin(), seal.end(), bytes->end() - kSealSize)) return nullptr;
  bytes->resize(size);
  try {
    return detail::semanticImage(description_, cv::imdecode(*bytes, cv::IMREAD_UNCHANGED),
                                 image.size(), class_of);
  } catch (const cv::Exception&) {
    return nullptr;
  } catch (const std::invalid_argument&) {
    return nullptr;
  }
}

void LabelCache::store(const cv::Mat& image, const SemanticImage& labels) const {
  const std::string key = keyOf(image);
  const std::string file = fileOf(key);
  std::vector<std::uint8_t> bytes;
  // With OpenCV's settings: others make smaller files, but take longer to read.
  if (!cv::imencode(".png", detail::storedForm(labels), bytes))
    throw FileError(file, "cannot be written: the output of the network is too large for a PNG");
  const std::string seal = computeSeal(key, bytes.data(), bytes.size());
  bytes.insert(bytes.end(), seal.begin(), seal.end());
  writeAtOnce(file, bytes);
}

}  // namespace csom
