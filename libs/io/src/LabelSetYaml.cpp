// SPDX-License-Identifier: BSD-3-Clause
// Label sets as YAML text: strict reading with the line of every error, and writing.
#include <csom/core/Error.h>
#include <csom/io/InputFile.h>
#include <csom/io/LabelSet.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <charconv>
#include <set>

namespace csom {

/// Reads one label set. Every problem is a FileError "origin: line N: what, found, what to do".
class LabelSetReader {
 public:
  explicit LabelSetReader(const std::string& origin) : origin_(origin) {}

  LabelSet read(const std::string& text) {
    YAML::Node root;
    try {
      root = YAML::Load(text);
    } catch (const YAML::Exception& error) {
      throw FileError(
          origin_, "line " + std::to_string(error.mark.line + 1) + ": no valid YAML: " + error.msg);
    }
    const auto fields = readFields(root, "the label set", {"name", "classes"}, {"raw"});
    set_.name_ = readName(fields.at("name"));
    readClasses(fields.at("classes"));
    if (fields.count("raw") != 0) readRaw(fields.at("raw"));
    return std::move(set_);
  }

 private:
  using Fields = std::map<std::string, YAML::Node>;

  [[noreturn]] void fail(const YAML::Node& at, const std::string& reason) const {
    const int line = std::max(at.Mark().line, 0) + 1;  // an empty text has no mark
    throw FileError(origin_, "line " + std::to_string(line) + ": " + reason);
  }

  /// The keys of a map, each at most once, all of `required`, none besides `optional`.
  Fields readFields(const YAML::Node& node, const std::string& what,
                    const std::set<std::string>& required,
                    const std::set<std::string>& optional) const {
    std::string known;
    for (const auto& names : {required, optional})
      for (const std::string& name : names) known += (known.empty() ? "" : ", ") + name;
    if (!node.IsMap()) fail(node, what + " must be a map with the keys " + known);
    Fields fields;
    for (const auto& item : node) {
      const std::string key = item.first.IsScalar() ? item.first.Scalar() : "";
      if (required.count(key) + optional.count(key) == 0)
        fail(item.first, "unknown key '" + key + "' in " + what + "; known are " + known);
      if (!fields.emplace(key, item.second).second)
        fail(item.first, "key '" + key + "' occurs twice in " + what);
    }
    for (const std::string& key : required)
      if (fields.count(key) == 0) fail(node, what + " lacks the key '" + key + "'");
    return fields;
  }

  std::string readName(const YAML::Node& node) const {
    if (!node.IsScalar() || node.Scalar().empty()) fail(node, "a name must be a non-empty word");
    for (const char c : node.Scalar())
      if (static_cast<unsigned char>(c) < 0x20) fail(node, "a name holds a control character");
    if (!isWrittenAsItIs(node.Scalar())) fail(node, "a name holds bytes that are not UTF-8");
    return node.Scalar();
  }

  /// A map file and a stream hold label sets as toYaml() writes them: what comes out must be what
  /// went in. YAML's writer replaces what is not UTF-8.
  static bool isWrittenAsItIs(const std::string& name) {
    YAML::Emitter out;
    out << YAML::DoubleQuoted << name;
    const YAML::Node again = YAML::Load(out.c_str());
    return again.IsScalar() && again.Scalar() == name;
  }

  /// An integer in [0, max].
  std::uint32_t readInteger(const YAML::Node& node, const std::string& what,
                            std::uint32_t max) const {
    std::uint32_t value = 0;
    const std::string text = node.IsScalar() ? node.Scalar() : "(not a number)";
    const char* end = text.data() + text.size();
    const auto result = std::from_chars(text.data(), end, value);
    if (result.ec != std::errc() || result.ptr != end || value > max)
      fail(node, what + " is '" + text + "', must be an integer from 0 to " + std::to_string(max));
    return value;
  }

  Color readColor(const YAML::Node& node) const {
    if (!node.IsSequence() || node.size() != 3)
      fail(node, "color must be a list of three integers [red, green, blue]");
    Color color{};
    for (std::size_t i = 0; i < 3; ++i)
      color[i] = static_cast<std::uint8_t>(readInteger(node[i], "a part of color", 255));
    return color;
  }

  void readClasses(const YAML::Node& node) {
    if (!node.IsSequence() || node.size() < 2)
      fail(node, "classes must be a list of at least two: 0 free and one more");
    if (node.size() > kMaxClasses)
      fail(node, std::to_string(node.size()) + " classes, at most " + std::to_string(kMaxClasses) +
                     " are possible");
    for (const auto& item : node) addClass(item);
  }

  void addClass(const YAML::Node& node) {
    const auto fields = readFields(node, "a class", {"id", "name", "color"}, {"free"});
    LabelClass c;
    c.id = static_cast<ClassId>(readInteger(fields.at("id"), "id", kMaxClasses - 1));
    c.name = readName(fields.at("name"));
    c.color = readColor(fields.at("color"));
    if (c.id != set_.classes_.size())
      fail(node, "class id " + std::to_string(c.id) + ", expected " +
                     std::to_string(set_.classes_.size()) +
                     ": ids run from 0 in order, without gaps or repetition");
    checkFree(c, fields);
    for (const LabelClass& other : set_.classes_) {
      if (other.name == c.name)
        fail(node, "classes " + std::to_string(other.id) + " and " + std::to_string(c.id) +
                       " have the same name '" + c.name + "'");
      if (other.color == c.color && other.id != kFreeClass)
        fail(node, "classes '" + other.name + "' and '" + c.name + "' have the same color");
    }
    set_.classes_.push_back(std::move(c));
  }

  /// Class 0 is free, written out or not, and no other is.
  void checkFree(const LabelClass& c, const Fields& fields) const {
    if (c.id == kFreeClass && c.name != "free")
      fail(fields.at("name"), "class 0 is named '" + c.name +
                                  "'; it is the class of empty space and must be named 'free'");
    const auto flag = fields.find("free");
    if (flag == fields.end()) return;
    const std::string text = flag->second.IsScalar() ? flag->second.Scalar() : "";
    if (text != "true" && text != "false") fail(flag->second, "free must be true or false");
    if ((text == "true") != (c.id == kFreeClass))
      fail(flag->second, "free is " + text + " at class " + std::to_string(c.id) +
                             "; class 0 is free and no other");
  }

  void readRaw(const YAML::Node& node) {
    if (!node.IsMap() || node.size() == 0)
      fail(node, "raw must map raw ids to class ids or 'ignore'; leave it out if they are equal");
    for (const auto& item : node) {
      const std::uint32_t raw_id = readInteger(item.first, "a raw id", 0xffffffffu);
      if (!set_.raw_.emplace(raw_id, readTarget(item.second)).second)
        fail(item.first, "raw id " + std::to_string(raw_id) + " occurs twice");
    }
  }

  LabelSet::Raw readTarget(const YAML::Node& node) const {
    if (node.IsScalar() && node.Scalar() == "ignore") return {LabelSet::RawKind::Ignored, 0};
    const auto last = static_cast<std::uint32_t>(set_.classes_.size() - 1);
    const std::uint32_t id = readInteger(node, "the class of a raw id (or 'ignore')", last);
    return {LabelSet::RawKind::Class, static_cast<ClassId>(id)};
  }

  std::string origin_;
  LabelSet set_;
};

LabelSet LabelSet::load(const std::string& file) {
  return fromYaml(detail::readFile(file), file);
}

LabelSet LabelSet::fromYaml(const std::string& text, const std::string& origin) {
  return LabelSetReader(origin).read(text);
}

std::string LabelSet::toYaml() const {
  YAML::Emitter out;
  out << YAML::BeginMap << YAML::Key << "name" << YAML::Value << name_;
  out << YAML::Key << "classes" << YAML::Value << YAML::BeginSeq;
  for (const LabelClass& c : classes_) {
    out << YAML::Flow << YAML::BeginMap << YAML::Key << "id" << YAML::Value << c.id;
    out << YAML::Key << "name" << YAML::Value << c.name;
    out << YAML::Key << "color" << YAML::Value << YAML::Flow << YAML::BeginSeq;
    for (const std::uint8_t part : c.color) out << static_cast<int>(part);
    out << YAML::EndSeq;
    if (c.id == kFreeClass) out << YAML::Key << "free" << YAML::Value << true;
    out << YAML::EndMap;
  }
  out << YAML::EndSeq;
  if (!raw_.empty()) {
    out << YAML::Key << "raw" << YAML::Value << YAML::BeginMap;
    for (const auto& [raw_id, target] : raw_) {
      out << YAML::Key << raw_id << YAML::Value;
      if (target.kind == RawKind::Ignored)
        out << "ignore";
      else
        out << target.id;
    }
    out << YAML::EndMap;
  }
  out << YAML::EndMap;
  return std::string(out.c_str()) + "\n";
}

}  // namespace csom
