// Collects the three frames of each obstacle. The obstacles of a cycle are accepted together if all are complete and
// the list that ends the cycle has their number. Otherwise the previous obstacles are kept.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/time.hpp"
#include "bus/messages.hpp"
#include "control/vehicle/types.hpp"

namespace loop {

[[nodiscard]] control::ObstacleShape ToControl(bus::Outline outline);
[[nodiscard]] control::ObstacleClass ToControl(bus::ObstacleClass object_class);

class ObstacleAssembler {
 public:
  static constexpr std::size_t kMaxObstacles = 64;

  ObstacleAssembler();

  // A part with a non-finite value, a semi-axis or a half side that is not positive is ignored: its object remains
  // incomplete.
  void Update(const bus::ObstaclePosition& position);
  void Update(const bus::ObstacleShape& shape);
  void Update(const bus::ObstacleMotion& motion);
  // Ends a cycle. True: `obstacles()` are those received since the previous list. False: a part was missing, or the
  // number of objects was wrong or above kMaxObstacles; `obstacles()` are unchanged.
  [[nodiscard]] bool Update(const bus::ObstacleList& list, base::Time time);

  // The obstacles in the order in which they were first received.
  [[nodiscard]] std::span<const control::Obstacle> obstacles() const { return committed_; }
  // Time since the last accepted list; Time::max() before the first.
  [[nodiscard]] base::Time Age(base::Time now) const { return known_ ? now - last_ : base::Time::max(); }
  [[nodiscard]] std::uint64_t rejected() const { return rejected_; }  // lists

 private:
  struct Pending {
    control::Obstacle obstacle;
    unsigned parts = 0;
  };

  [[nodiscard]] control::Obstacle* Part(std::uint8_t id, unsigned part);

  std::vector<Pending> pending_;
  bool overflow_ = false;
  std::vector<control::Obstacle> committed_;
  bool known_ = false;
  base::Time last_{};
  std::uint64_t rejected_ = 0;
};

}  // namespace loop
