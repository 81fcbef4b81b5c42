// SPDX-License-Identifier: BSD-3-Clause
#include "PcdHeader.h"

#include <csom/core/Error.h>
#include <csom/io/TextParser.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <set>

namespace csom::detail {

namespace {

/// Far above any cloud; keeps sums of sizes from overflowing.
constexpr std::size_t kMaxFields = 1000;
constexpr std::size_t kMaxCount = 1000000;

/// Some editors write it in front of a text.
constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

bool equalInAnyCase(std::string_view a, std::string_view b) {
  return lowerCase(a) == lowerCase(b);
}

class HeaderReader {
 public:
  HeaderReader(std::string_view bytes, const std::string& file)
      : file_(file),
        skipped_(bytes.substr(0, kByteOrderMark.size()) == kByteOrderMark ? kByteOrderMark.size()
                                                                          : 0),
        lines_(bytes.substr(skipped_)) {}

  PcdHeader read() {
    while (!done_) {
      std::string_view line;
      if (!lines_.next(line)) throw FileError(file_, "is no PCD file: it has no line 'DATA'");
      splitColumns(line, words_);
      if (words_.empty() || words_.front().front() == '#') continue;
      entry_ = words_.front();
      key_ = entry_;
      std::transform(key_.begin(), key_.end(), key_.begin(),
                     [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
      words_.erase(words_.begin());
      readEntry();
    }
    finish();
    return std::move(header_);
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const {
    throw FileError(file_, "line " + std::to_string(lines_.lineNumber()) + ": " + reason);
  }

  void readEntry() {
    if (key_ == "VERSION") {
      double version = 0;
      // Older ones lack entries of the header that then have their defaults.
      if (words_.size() != 1 || !parseNumber(words_[0], version) || !(version > 0) || version > 0.7)
        fail("PCD version " + (words_.empty() ? "''" : quoted(words_[0])) +
             "; versions up to 0.7 are read");
    } else if (key_ == "FIELDS" || key_ == "COLUMNS") {
      readFields();
    } else if (key_ == "SIZE") {
      forEachField([&](PcdField& field, std::size_t value) {
        if (value != 1 && value != 2 && value != 4 && value != 8)
          fail("SIZE of field " + quoted(field.name) + " is " + std::to_string(value) +
               ", must be 1, 2, 4 or 8");
        field.size = value;
      });
    } else if (key_ == "TYPE") {
      readTypes();
    } else if (key_ == "COUNT") {
      forEachField([&](PcdField& field, std::size_t value) {
        if (value > kMaxCount)
          fail("COUNT of field " + quoted(field.name) + " is " + std::to_string(value) +
               ", must be " + std::to_string(kMaxCount) + " at most");
        field.count = value;
      });
    } else if (key_ == "WIDTH") {
      width_ = readNumber();
    } else if (key_ == "HEIGHT") {
      height_ = readNumber();
    } else if (key_ == "POINTS") {
      points_ = readNumber();
    } else if (key_ == "VIEWPOINT") {
      readViewpoint();
    } else if (key_ == "DATA") {
      readData();
    } else {
      fail("unknown entry " + quoted(entry_) + " in the header of a PCD file");
    }
  }

  void readFields() {
    if (words_.empty() || words_.size() > kMaxFields || !header_.fields.empty())
      fail("FIELDS must occur once and name 1 to " + std::to_string(kMaxFields) + " fields");
    for (const std::string_view name : words_) {
      PcdField field;
      field.name = name;
      if (!field.isPadding() && !names_.insert(field.name).second)
        fail("two FIELDS are called " + quoted(name) + "; which one counts?");
      header_.fields.push_back(field);
    }
  }

  void checkWordPerField() const {
    if (words_.size() != header_.fields.size())
      fail(std::string(key_) + " has " + std::to_string(words_.size()) + " entries for " +
           std::to_string(header_.fields.size()) + " FIELDS");
  }

  template <class Setter>
  void forEachField(Setter&& set) {
    checkWordPerField();
    for (std::size_t i = 0; i < words_.size(); ++i) {
      std::size_t value = 0;
      if (!parseNumber(words_[i], value))
        fail(std::string(key_) + " " + quoted(words_[i]) + " is not a whole number");
      set(header_.fields[i], value);
    }
  }

  void readTypes() {
    checkWordPerField();
    for (std::size_t i = 0; i < words_.size(); ++i) {
      if (words_[i] != "F" && words_[i] != "U" && words_[i] != "I")
        fail("TYPE " + quoted(words_[i]) + " is none of F, U, I");
      header_.fields[i].type = words_[i].front();
    }
  }

  std::size_t readNumber() const {
    std::size_t value = 0;
    if (words_.size() != 1 || !parseNumber(words_[0], value))
      fail(std::string(key_) + " must be followed by one whole number");
    return value;
  }

  void readViewpoint() {
    double v[7] = {};
    bool valid = words_.size() == 7;
    for (std::size_t i = 0; valid && i < 7; ++i)
      valid = parseNumber(words_[i], v[i]) && std::isfinite(v[i]);
    header_.viewpoint = Eigen::Vector3d(v[0], v[1], v[2]);
    header_.viewpoint_rotation = Eigen::Quaterniond(v[3], v[4], v[5], v[6]);
    if (!valid || !(std::abs(header_.viewpoint_rotation.norm() - 1) <= 0.01))
      fail("VIEWPOINT must be 'x y z qw qx qy qz' with a quaternion of length 1");
    header_.viewpoint_rotation.normalize();
  }

  void readData() {
    const std::string_view kind = words_.size() == 1 ? words_[0] : "";
    if (equalInAnyCase(kind, "ascii"))
      header_.data = PcdHeader::Data::Ascii;
    else if (equalInAnyCase(kind, "binary"))
      header_.data = PcdHeader::Data::Binary;
    else if (equalInAnyCase(kind, "binary_compressed"))
      header_.data = PcdHeader::Data::Compressed;
    else
      fail("DATA must be ascii, binary or binary_compressed");
    header_.data_begin = skipped_ + lines_.position();
    header_.lines = lines_.lineNumber();
    done_ = true;
  }

  /// What can be said only when all entries are known.
  void finish() {
    if (header_.fields.empty()) fail("the header has no FIELDS");
    for (PcdField& field : header_.fields) {
      if (field.type == 'F' && field.size < 4)
        fail("field " + quoted(field.name) + " is of TYPE F and SIZE " +
             std::to_string(field.size) + ", must be 4 or 8");
      field.column = header_.columns;
      field.offset = header_.point_bytes;
      header_.columns += field.count;
      header_.point_bytes += field.count * field.size;
    }
    for (const char* name : {"x", "y", "z"})
      if (header_.find(name) == nullptr) fail(std::string("FIELDS lacks '") + name + "'");
    if (!points_ && !width_) fail("the header has neither POINTS nor WIDTH");
    if (!points_ && !height_) points_ = width_;  // not in rows
    if (width_ && height_) {
      if (*height_ != 0 && *width_ > std::numeric_limits<std::size_t>::max() / *height_)
        fail("WIDTH times HEIGHT is impossibly large");
      if (points_ && *points_ != *width_ * *height_)
        fail("POINTS " + std::to_string(*points_) + " is not WIDTH " + std::to_string(*width_) +
             " times HEIGHT " + std::to_string(*height_));
      points_ = *width_ * *height_;
    }
    header_.points = *points_;
  }

  std::string file_;
  std::size_t skipped_;  ///< bytes before the first line
  LineReader lines_;
  std::string_view entry_;  ///< first word of the line
  std::string key_;         ///< the same in capitals
  std::set<std::string> names_;
  std::vector<std::string_view> words_;
  std::optional<std::size_t> width_;
  std::optional<std::size_t> height_;
  std::optional<std::size_t> points_;
  bool done_ = false;
  PcdHeader header_;
};

}  // namespace

const PcdField* PcdHeader::find(std::string_view name) const {
  const PcdField* similar = nullptr;
  for (const PcdField& field : fields) {
    if (field.count != 1) continue;
    if (field.name == name) return &field;
    if (similar == nullptr && equalInAnyCase(field.name, name)) similar = &field;
  }
  return similar;
}

PcdHeader readPcdHeader(std::string_view bytes, const std::string& file) {
  return HeaderReader(bytes, file).read();
}

}  // namespace csom::detail
