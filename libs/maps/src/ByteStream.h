// SPDX-License-Identifier: BSD-3-Clause
// Values to bytes and back, little-endian, for the serialised form of a map.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace csom {

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "serialised maps are little-endian");
static_assert(sizeof(std::size_t) == sizeof(std::uint64_t), "and have counts of 64 bits");

class ByteWriter {
 public:
  template <class Number>
  void number(Number value) {
    static_assert(std::is_arithmetic_v<Number>);
    raw(&value, sizeof value);
  }
  void text(const std::string& value) {
    number(static_cast<std::uint32_t>(value.size()));
    raw(value.data(), value.size());
  }
  /// Numbers or texts by their names.
  template <class Value>
  void named(const std::map<std::string, Value>& values) {
    number(static_cast<std::uint64_t>(values.size()));
    for (const auto& [name, value] : values) {
      text(name);
      if constexpr (std::is_arithmetic_v<Value>)
        number(value);
      else
        text(value);
    }
  }
  void raw(const void* data, std::size_t size) {
    const auto* begin = static_cast<const std::uint8_t*>(data);
    bytes_.insert(bytes_.end(), begin, begin + size);
  }
  void reserve(std::size_t size) { bytes_.reserve(size); }
  const std::vector<std::uint8_t>& bytes() const { return bytes_; }

 private:
  std::vector<std::uint8_t> bytes_;
};

/// Every read throws std::runtime_error if fewer bytes are left than it needs.
class ByteReader {
 public:
  /// The bytes must outlive the reader.
  ByteReader(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  template <class Number>
  Number number() {
    static_assert(std::is_arithmetic_v<Number>);
    Number value;
    std::memcpy(&value, raw(sizeof value), sizeof value);
    return value;
  }
  bool flag() {
    const auto value = number<std::uint8_t>();
    if (value > 1) throw std::runtime_error("serialised map: a flag that is neither 0 nor 1");
    return value == 1;
  }
  std::string text() {
    const auto size = number<std::uint32_t>();
    return std::string(static_cast<const char*>(raw(size)), size);
  }
  /// A number of items that take at least `bytes_each`, which is checked against what is left.
  std::size_t count(std::size_t bytes_each) {
    const auto value = number<std::uint64_t>();
    if (value > left() / bytes_each)
      throw std::runtime_error("serialised map: " + std::to_string(value) + " items stated, " +
                               std::to_string(left()) + " bytes left");
    return static_cast<std::size_t>(value);
  }
  /// What named() wrote. Throws std::runtime_error if a name is there twice.
  template <class Value>
  std::map<std::string, Value> named() {
    constexpr bool kIsNumber = std::is_arithmetic_v<Value>;
    constexpr std::size_t kSmallest =
        sizeof(std::uint32_t) + (kIsNumber ? sizeof(Value) : sizeof(std::uint32_t));
    std::map<std::string, Value> values;
    for (std::size_t left = count(kSmallest); left > 0; --left) {
      const std::string name = text();
      if (values.count(name) > 0)
        throw std::runtime_error("serialised map: '" + name + "' is there twice");
      if constexpr (kIsNumber)
        values[name] = number<Value>();
      else
        values[name] = text();
    }
    return values;
  }
  const void* raw(std::size_t size) {
    if (size > left())
      throw std::runtime_error("serialised map ends at byte " + std::to_string(size_) + " where " +
                               std::to_string(size) + " more are needed");
    const std::uint8_t* data = data_ + position_;
    position_ += size;
    return data;
  }
  std::size_t left() const { return size_ - position_; }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
  std::size_t position_ = 0;
};

}  // namespace csom
