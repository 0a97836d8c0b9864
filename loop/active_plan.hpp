// The inputs of the last accepted plan. They are used, as far as they reach, for every step without a newer plan.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "control/mpc/controller.hpp"

namespace loop {

class ActivePlan {
 public:
  explicit ActivePlan(int horizon) { u_.reserve(static_cast<std::size_t>(horizon)); }

  // `plan` was made at `step`, to which its first input applies. Does not allocate.
  void Set(const control::Plan& plan, std::int64_t step) {
    u_.assign(plan.u.begin(), plan.u.end());
    beyond_ = plan.beyond;
    made_ = step;
  }
  void Clear() { u_.clear(); }

  [[nodiscard]] bool exists() const { return !u_.empty(); }
  // Steps since the plan was made; meaningless without a plan.
  [[nodiscard]] int Age(std::int64_t step) const { return static_cast<int>(step - made_); }
  // True if there is an input for `step`.
  [[nodiscard]] bool Covers(std::int64_t step) const {
    return step >= made_ && step - made_ < static_cast<std::int64_t>(u_.size());
  }
  // Number of steps after `step` for which there is an input.
  [[nodiscard]] int Left(std::int64_t step) const {
    return Covers(step) ? static_cast<int>(u_.size()) - 1 - Age(step) : 0;
  }
  // Requires Covers(step).
  [[nodiscard]] const control::Input& At(std::int64_t step) const {
    return u_[static_cast<std::size_t>(step - made_)];
  }
  // The inputs from `step` on; empty if the plan does not cover it.
  [[nodiscard]] std::span<const control::Input> From(std::int64_t step) const {
    if (!Covers(step)) return {};
    return std::span(u_).subspan(static_cast<std::size_t>(step - made_));
  }
  // The path that leads on beyond the last input.
  [[nodiscard]] const control::LateralPath& beyond() const { return beyond_; }

 private:
  std::vector<control::Input> u_;
  control::LateralPath beyond_;
  std::int64_t made_ = 0;
};

}  // namespace loop
