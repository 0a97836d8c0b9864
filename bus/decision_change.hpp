// Finds the cycles in which another decision was taken, so that each is told once, and one that is given up at once is not
// told at all: between two decisions that are about as good, a controller may change its mind for a cycle or two.
#pragma once

#include "bus/messages.hpp"

namespace bus {

class DecisionChange {
 public:
  // Cycles for which a decision must hold before it is told, and for which another reason for the same decision must. The
  // first decision and one to use the margins up are told at once.
  static constexpr int kSteady = 5;
  static constexpr int kSteadyReason = 20;

  // Takes what was decided in a cycle. True if it is to be told: it is another decision than the last one that was, about
  // another object, on another side, or for another reason. A cycle without a decision changes nothing.
  [[nodiscard]] bool Take(const ManoeuvreStatus& manoeuvre) {
    if (manoeuvre.decision == ManoeuvreDecision::kNone) return false;
    const bool other = Differ(manoeuvre, told_);
    if (!other && manoeuvre.reason == told_.reason) {
      held_ = 0;
      return false;
    }
    const bool holds = !Differ(manoeuvre, next_) && (other || manoeuvre.reason == next_.reason);
    held_ = holds && held_ > 0 ? held_ + 1 : 1;
    next_ = manoeuvre;
    const bool at_once = told_.decision == ManoeuvreDecision::kNone ||
                         (other && manoeuvre.decision == ManoeuvreDecision::kSqueeze);
    if (!at_once && held_ < (other ? kSteady : kSteadyReason)) return false;
    told_ = manoeuvre;
    return true;
  }
  // Cycles for which the decision told last had held when it was.
  [[nodiscard]] int held() const { return held_; }
  // The next decision is another one.
  void Reset() { *this = {}; }

 private:
  // A side that is not known is no other side.
  [[nodiscard]] static bool Differ(const ManoeuvreStatus& a, const ManoeuvreStatus& b) {
    const bool sides = a.side != b.side && a.side != PassingSide::kUnknown && b.side != PassingSide::kUnknown;
    return a.decision != b.decision || a.object_id != b.object_id || sides;
  }

  ManoeuvreStatus told_;
  ManoeuvreStatus next_;  // may be told next
  int held_ = 0;          // cycles for which it has held
};

}  // namespace bus
