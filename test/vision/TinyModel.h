// SPDX-License-Identifier: BSD-3-Clause
// A real ONNX file whose output is known: averages over cells, times a matrix. And images for it.
#pragma once

#include <cstdint>
#include <cstring>
#include <opencv2/core.hpp>
#include <string>
#include <utility>
#include <vector>

namespace csom::test {

/// A message of Protocol Buffers, written field by field.
class ProtobufMessage {
 public:
  ProtobufMessage& number(unsigned field, std::uint64_t value) {
    varint(field << 3);
    varint(value);
    return *this;
  }
  ProtobufMessage& text(unsigned field, const std::string& value) {
    varint(field << 3 | 2);
    varint(value.size());
    bytes_ += value;
    return *this;
  }
  ProtobufMessage& message(unsigned field, const ProtobufMessage& value) {
    return text(field, value.bytes_);
  }
  const std::string& bytes() const { return bytes_; }

 private:
  void varint(std::uint64_t value) {
    for (; value > 127; value >>= 7) bytes_ += static_cast<char>(value | 128);
    bytes_ += static_cast<char>(value);
  }

  std::string bytes_;
};

inline cv::Mat randomImage(cv::Size size, int type, unsigned seed) {
  cv::Mat image(size, type);
  cv::RNG random(seed);
  random.fill(image, cv::RNG::UNIFORM, 0, 256);
  return image;
}

/// score_k = Σ_c weight[k][c] · mean of channel c over the cell + bias[k].
struct TinyModel {
  enum class Head { Logits, Softmax, ArgMax, ArgMaxWithChannel };

  std::vector<std::vector<float>> weights;  ///< a row a channel of the output
  std::vector<float> biases;
  int cell = 1;  ///< pixels of the input a side of a cell of the output
  Head head = Head::Logits;
  bool second_output = false;  ///< one more, "other", with the scores that are above 0
  int batch = 1;
  int width = 0;
  int height = 0;

  /// An ONNX file (opset 13). The output is called "scores".
  std::string onnx() const {
    const std::string last = head == Head::Logits ? "scores" : "logits";
    ProtobufMessage graph;
    graph.message(
        1, node("Conv", {"image", "weights", "biases"}, last,
                {integers("kernel_shape", {cell, cell}), integers("strides", {cell, cell})}));
    if (head == Head::Softmax)
      graph.message(1, node("Softmax", {last}, "scores", {integer("axis", 1)}));
    if (head == Head::ArgMax || head == Head::ArgMaxWithChannel)
      graph.message(1, node("ArgMax", {last}, "scores",
                            {integer("axis", 1),
                             integer("keepdims", head == Head::ArgMaxWithChannel ? 1 : 0)}));
    if (second_output) graph.message(1, node("Relu", {last}, "other", {}));
    graph.text(2, "tiny");
    const int inputs = static_cast<int>(weights.front().size());
    const int outputs = static_cast<int>(weights.size());
    std::vector<float> kernel;
    for (const auto& row : weights) {
      for (const float weight : row)
        kernel.insert(kernel.end(), static_cast<std::size_t>(cell * cell),
                      weight / static_cast<float>(cell * cell));
    }
    graph.message(5, tensor("weights", {outputs, inputs, cell, cell}, kernel));
    graph.message(5, tensor("biases", {outputs}, biases));
    graph.message(11, value("image", {batch, inputs, height, width}));
    graph.message(12, value("scores", {batch, outputs, height / cell, width / cell}));
    if (second_output)
      graph.message(12, value("other", {batch, outputs, height / cell, width / cell}));
    return ProtobufMessage()
        .number(1, 7)
        .message(7, graph)
        .message(8, ProtobufMessage().text(1, "").number(2, 13))
        .bytes();
  }

 private:
  using Sizes = std::vector<int>;

  static ProtobufMessage integer(const std::string& name, int number) {
    return ProtobufMessage()
        .text(1, name)
        .number(3, static_cast<std::uint64_t>(number))
        .number(20, 2);
  }
  static ProtobufMessage integers(const std::string& name, const Sizes& numbers) {
    ProtobufMessage attribute;
    attribute.text(1, name);
    for (const int number : numbers) attribute.number(8, static_cast<std::uint64_t>(number));
    return attribute.number(20, 7);
  }
  static ProtobufMessage node(const std::string& type, const std::vector<std::string>& inputs,
                              const std::string& output,
                              const std::vector<ProtobufMessage>& attributes) {
    ProtobufMessage node;
    for (const std::string& input : inputs) node.text(1, input);
    node.text(2, output).text(3, type).text(4, type);
    for (const ProtobufMessage& attribute : attributes) node.message(5, attribute);
    return node;
  }
  static ProtobufMessage tensor(const std::string& name, const Sizes& sizes,
                                const std::vector<float>& numbers) {
    ProtobufMessage tensor;
    for (const int size : sizes) tensor.number(1, static_cast<std::uint64_t>(size));
    std::string raw(numbers.size() * sizeof(float), '\0');
    std::memcpy(raw.data(), numbers.data(), raw.size());
    return tensor.number(2, 1).text(8, name).text(9, raw);
  }
  static ProtobufMessage value(const std::string& name, const Sizes& sizes) {
    ProtobufMessage shape;
    for (const int size : sizes)
      shape.message(1, ProtobufMessage().number(1, static_cast<std::uint64_t>(size)));
    const ProtobufMessage type = ProtobufMessage().number(1, 1).message(2, shape);
    return ProtobufMessage().text(1, name).message(2, ProtobufMessage().message(1, type));
  }
};

}  // namespace csom::test
