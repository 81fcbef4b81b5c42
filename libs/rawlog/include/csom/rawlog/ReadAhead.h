// SPDX-License-Identifier: BSD-3-Clause
// Makes things in a thread of its own, while others are worked on.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

namespace csom {
namespace detail {

/// Lets the calling thread stand back behind the others of the process where processors are short:
/// what is made ahead is not urgent, and must not slow down those who take it.
void giveWay();

}  // namespace detail

/// Calls `make` again and again in its own thread, until it gives nothing, and keeps at most
/// `capacity` of what it gave, in order. For one thread that takes.
template <typename Item>
class ReadAhead {
 public:
  ReadAhead(std::size_t capacity, std::function<std::optional<Item>()> make)
      : capacity_(capacity), make_(std::move(make)), thread_([this] { run(); }) {}

  /// Waits until the call of `make` that is under way has returned.
  ~ReadAhead() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      stopping_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }
  ReadAhead(const ReadAhead&) = delete;
  ReadAhead& operator=(const ReadAhead&) = delete;

  /// The next one; nothing after the last. What `make` throws arrives here, behind all that it gave
  /// before.
  std::optional<Item> next() {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [this] { return !items_.empty() || ended_; });
    if (items_.empty()) {
      if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
      return std::nullopt;
    }
    std::optional<Item> item(std::move(items_.front()));
    items_.pop_front();
    lock.unlock();
    changed_.notify_all();
    return item;
  }

 private:
  void run() {
    detail::giveWay();
    std::exception_ptr error;
    try {
      while (auto item = make_()) {
        if (!put(std::move(*item))) break;
      }
    } catch (...) {
      error = std::current_exception();
    }
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      error_ = error;
      ended_ = true;
    }
    changed_.notify_all();
  }

  /// False if nobody will take it.
  bool put(Item item) {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [this] { return items_.size() < capacity_ || stopping_; });
    if (stopping_) return false;
    items_.push_back(std::move(item));
    lock.unlock();
    changed_.notify_all();
    return true;
  }

  const std::size_t capacity_;
  const std::function<std::optional<Item>()> make_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Item> items_;
  std::exception_ptr error_;
  bool ended_ = false;
  bool stopping_ = false;
  std::thread thread_;  ///< the last member: it uses all others
};

}  // namespace csom
