// The rows of highest priority among those offered, at most kCapacity.
#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace control {

struct RowPlace {
  std::size_t stage, row;
  double priority;
};

template <int kCapacity>
class MostViolated {
 public:
  void Clear() { size_ = 0; }
  // Keeps the row if fewer than kCapacity rows have a priority at least as high.
  void Offer(const RowPlace& place) {
    if (size_ == kCapacity && rows_.back().priority >= place.priority) return;
    if (size_ < kCapacity) ++size_;
    std::size_t k = size_ - 1;
    for (; k > 0 && rows_[k - 1].priority < place.priority; --k) rows_[k] = rows_[k - 1];
    rows_[k] = place;
  }
  [[nodiscard]] int size() const { return static_cast<int>(size_); }
  // Rows in order of falling priority.
  [[nodiscard]] std::span<const RowPlace> rows() const { return {rows_.data(), size_}; }

 private:
  std::array<RowPlace, kCapacity> rows_;
  std::size_t size_ = 0;
};

}  // namespace control
