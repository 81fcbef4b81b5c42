// SPDX-License-Identifier: BSD-3-Clause
// Reads a rawlog or a simplemap one entry at a time.
#include <csom/core/Error.h>
#include <csom/io/TextParser.h>
#include <csom/rawlog/RawlogReader.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/io/lazy_load_path.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3DPDF.h>
#include <mrpt/poses/CPosePDF.h>
#include <mrpt/serialization/CArchive.h>

#include <filesystem>
#include <new>
#include <stdexcept>
#include <utility>

#include "logs/MrptText.h"
#include "run/CrashReport.h"
#include "run/MemoryLimit.h"

namespace csom {

using mrpt::serialization::CSerializable;

namespace {

using mrpt::rtti::TRuntimeClassId;

constexpr char kTooLarge[] = "it claims to be larger than the file can hold";
constexpr char kNoRawlog[] = "is neither a rawlog nor a simplemap";

/// Memory that one entry may take: far more than any that gzip or JPEG made small.
constexpr std::uint64_t kMemoryAtLeast = std::uint64_t{512} << 20;
constexpr std::uint64_t kMemoryPerByte = 64;

/// Why a file cannot even be opened; empty if it can.
std::string whyUnreadable(const std::string& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) return "no such file";
  if (std::filesystem::is_directory(status)) return "is a folder, not a rawlog";
  if (!std::filesystem::is_regular_file(status)) return "is not a regular file";
  if (std::filesystem::file_size(file, error) == 0) return "is empty";
  return {};
}

/// MRPT's convention, also for names that end in .gz or contain dots.
std::string imageFolderOf(const std::string& file) {
  const std::filesystem::path path(file);
  const std::filesystem::path folder = path.parent_path();
  std::string stem = path.filename().string();
  for (const char* extension : {".gz", ".rawlog", ".simplemap"}) {
    const std::string end = extension;
    if (stem.size() > end.size() && stem.compare(stem.size() - end.size(), end.size(), end) == 0)
      stem.resize(stem.size() - end.size());
  }
  for (const char* suffix : {"_Images", "_images", "_IMAGES"}) {
    if (std::filesystem::is_directory(folder / (stem + suffix)))
      return (folder / (stem + suffix)).string();
  }
  return (folder / "Images").string();
}

bool isLogClass(const TRuntimeClassId& id) {
  return id.derivedFrom(CLASS_ID(mrpt::obs::CObservation)) ||
         &id == CLASS_ID(mrpt::obs::CSensoryFrame) || &id == CLASS_ID(mrpt::obs::CActionCollection);
}

}  // namespace

/// MRPT's own archive takes a short read for a full one; this one does not.
class RawlogReader::Archive : public mrpt::serialization::CArchive {
 public:
  struct Header {
    std::string class_name;
    bool old_format = false;
    std::int8_t version = 0;
    /// Null for a stored null pointer and for a class that is not registered.
    const TRuntimeClassId* class_id = nullptr;
    bool isNull() const { return class_name == "nullptr"; }
  };

  explicit Archive(const std::string& file) { open_ = stream_.open(file); }

  bool isOpen() const { return open_; }
  bool cutOff() const { return cut_off_; }
  std::uint64_t position() const { return position_; }
  /// Class of the object being read, for messages.
  const std::string& currentClass() const { return current_.class_name; }

  /// True if not one byte is left.
  bool atEnd() {
    if (!peeked_) peeked_ = stream_.Read(&peeked_byte_, 1) == 1;
    return !peeked_;
  }

  const Header& readHeader() {
    current_ = {};
    internal_ReadObjectHeader(current_.class_name, current_.old_format, current_.version);
    if (!current_.isNull())
      current_.class_id = mrpt::rtti::findRegisteredClass(current_.class_name);
    return current_;
  }

  /// The object whose header was read last.
  CSerializable::Ptr readBody() {
    CSerializable::Ptr object;
    if (!current_.isNull()) {
      if (current_.class_id == nullptr)
        throw std::runtime_error("its class is not known to this version of MRPT");
      object = std::dynamic_pointer_cast<CSerializable>(current_.class_id->createObject());
      if (!object) throw std::runtime_error("its class cannot be stored in a file");
    }
    internal_ReadObject(object.get(), current_.class_name, current_.old_format, current_.version);
    return object;
  }

  CSerializable::Ptr readWhole() {
    readHeader();
    return readBody();
  }

 protected:
  std::size_t read(void* buffer, std::size_t size) override {
    auto* bytes = static_cast<std::uint8_t*>(buffer);
    std::size_t missing = size;
    if (peeked_ && missing > 0) {
      *bytes++ = peeked_byte_;
      --missing;
      peeked_ = false;
    }
    if (missing > 0 && stream_.Read(bytes, missing) != missing) {
      cut_off_ = true;
      throw std::runtime_error("the file ends here");
    }
    position_ += size;
    return size;
  }
  std::size_t write(const void*, std::size_t) override {
    throw std::logic_error("a rawlog is only read");
  }

 private:
  mrpt::io::CFileGZInputStream stream_;
  bool open_ = false;
  bool cut_off_ = false;
  bool peeked_ = false;
  std::uint8_t peeked_byte_ = 0;
  std::uint64_t position_ = 0;
  Header current_;
};

/// For as long as a part of a log is read that may be damaged.
struct RawlogReader::Guard {
  Guard(std::uint64_t memory_allowance, const std::string& crash_line)
      : limit(memory_allowance), report(crash_line) {}
  detail::MemoryLimit limit;
  detail::CrashReport report;
};

RawlogReader::RawlogReader(const std::string& file, Soundness soundness)
    : file_(file), image_folder_(imageFolderOf(file)), soundness_(soundness) {
  if (const std::string reason = whyUnreadable(file); !reason.empty())
    throw FileError(file, reason);
  memory_allowance_ = kMemoryAtLeast + kMemoryPerByte * std::filesystem::file_size(file);
  archive_ = std::make_unique<Archive>(file);
  if (!archive_->isOpen()) throw FileError(file, "cannot be opened for reading");
  mrpt::io::setLazyLoadPathBase(image_folder_);
  readStart();
}

RawlogReader::~RawlogReader() = default;

bool RawlogReader::isSimpleMap() const {
  return simplemap_version_ >= 0;
}

void RawlogReader::readStart() {
  const std::unique_ptr<Guard> guarded = guard();
  if (archive_->atEnd()) throw FileError(file_, "is empty");
  Archive::Header header;
  try {
    header = archive_->readHeader();
  } catch (const std::exception&) {
    throw FileError(file_, kNoRawlog);
  }
  if (header.class_id == nullptr) throw FileError(file_, kNoRawlog);

  const bool is_simplemap = header.class_id == CLASS_ID(mrpt::maps::CSimpleMap);
  if (is_simplemap || header.class_id == CLASS_ID(mrpt::obs::CRawlog)) {
    if (is_simplemap) simplemap_version_ = header.version;
    if (simplemap_version_ > 1)
      throw FileError(file_, "is a simplemap of format " + std::to_string(simplemap_version_) +
                                 ", later than this version of MRPT reads");
    try {
      remaining_ = archive_->ReadAs<std::uint32_t>();
    } catch (const std::exception&) {
      stopAt("the file ends before its first entry");
    }
    return;
  }
  if (!isLogClass(*header.class_id))
    throw FileError(file_, std::string(kNoRawlog) + ": it starts with a " +
                               detail::printable(detail::shortName(header.class_name)));
  try {
    RawlogEntry entry;
    accept(archive_->readBody(), entry);
    first_ = std::move(entry);
  } catch (const std::bad_alloc&) {
    stopAt(kTooLarge);
  } catch (const std::exception& error) {
    stopAt(detail::oneLine(error));
  }
}

std::optional<RawlogEntry> RawlogReader::next() {
  if (stopped_) return std::nullopt;
  RawlogEntry entry;
  if (first_) {
    entry = std::move(*first_);
    first_.reset();
  } else {
    try {
      const std::unique_ptr<Guard> guarded = guard();
      if (!readEntry(entry)) {
        stopped_ = true;
        return std::nullopt;
      }
    } catch (const std::bad_alloc&) {
      stopAt(kTooLarge);
      return std::nullopt;
    } catch (const std::exception& error) {
      stopAt(detail::oneLine(error));
      return std::nullopt;
    }
  }
  entry.index = end_.entries++;
  end_.bytes = archive_->position();
  return entry;
}

/// False at the regular end.
bool RawlogReader::readEntry(RawlogEntry& entry) {
  if (remaining_) {
    if (*remaining_ == 0) return false;
    --*remaining_;
  } else if (archive_->atEnd()) {
    return false;
  }
  if (!isSimpleMap()) {
    accept(archive_->readWhole(), entry);
    return true;
  }
  const CSerializable::Ptr pose = archive_->readWhole();
  if (const auto in_3d = std::dynamic_pointer_cast<mrpt::poses::CPose3DPDF>(pose))
    entry.key_frame_pose = in_3d->getMeanVal();
  else if (const auto in_2d = std::dynamic_pointer_cast<mrpt::poses::CPosePDF>(pose))
    entry.key_frame_pose = mrpt::poses::CPose3D(in_2d->getMeanVal());
  else
    throw std::runtime_error("a key frame without a pose");
  if (!accept(archive_->readWhole(), entry))
    throw std::runtime_error("a key frame without observations");
  return true;
}

/// Logs may hold objects of any class; those that say nothing about the world are passed over.
bool RawlogReader::accept(const CSerializable::Ptr& object, RawlogEntry& entry) const {
  if (const auto comment = std::dynamic_pointer_cast<mrpt::obs::CObservationComment>(object)) {
    entry.comment = comment->text;
    return false;
  }
  if (const auto observation = std::dynamic_pointer_cast<mrpt::obs::CObservation>(object)) {
    entry.observations.push_back(observation);
    return true;
  }
  if (const auto frame = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(object)) {
    for (const auto& observation : *frame) {
      if (observation) entry.observations.push_back(observation);
    }
    return true;
  }
  entry.action = std::dynamic_pointer_cast<mrpt::obs::CActionCollection>(object);
  return entry.action != nullptr;
}

std::unique_ptr<RawlogReader::Guard> RawlogReader::guard() const {
  if (soundness_ == Soundness::Known) return nullptr;
  return std::make_unique<Guard>(memory_allowance_, crashLine());
}

std::string RawlogReader::crashLine() const {
  return "csom: " + file_ + ": entry " + std::to_string(end_.entries) +
         " is damaged so badly that MRPT crashes reading it; cut the file before it (rawlog-edit)";
}

void RawlogReader::stopAt(const std::string& reason) {
  stopped_ = true;
  end_.complete = false;
  const std::string class_name = detail::printable(detail::shortName(archive_->currentClass()));
  const std::string where =
      "entry " + std::to_string(end_.entries) + (class_name.empty() ? "" : " (" + class_name + ")");
  end_.reason =
      archive_->cutOff() ? "cut off in the middle of " + where : where + " is damaged: " + reason;
}

}  // namespace csom
