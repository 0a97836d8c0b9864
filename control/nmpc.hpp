// The paper's NMPC (eq:nonlinear_MPC): the nonlinear program of nmpc_problem.hpp, solved by Ipopt (Wächter, Biegler
// 2006) from the last solution, shifted by a step. For comparison: it allocates, its time has no bound but a coarse
// one, and two threads must not solve at the same time, since MUMPS below Ipopt is not made for that.
//
// Its solution is a local one. On which side an obstacle is passed (assum_1) is decided by the start: points of it that
// lie inside are first moved out on that side.
//
// Status: kSolved to the tolerance; kInfeasible: Ipopt ended in a point where the violation of the constraints is
// smallest near by, which is no proof; kIterationLimit: the limit of iterations or time; kNumericalFailure: all else.
#pragma once

#include <memory>
#include <optional>

#include "control/constraint.hpp"
#include "control/controller.hpp"
#include "control/mpc_settings.hpp"
#include "control/vehicle_parameters.hpp"

namespace control {

struct NmpcSettings : MpcSettings {
  double tolerance = 1e-4;  // of Ipopt (paper, Section Results); leaves up to 5e-3 in the input
  int max_iterations = 100;
  double max_cpu_time = 0.25;  // of one step [s]
};

class Nmpc final : public Controller {
 public:
  // Throws std::runtime_error: Ipopt refuses its options.
  Nmpc(const VehicleParameters& vehicle, const NmpcSettings& settings);
  ~Nmpc() override;
  Nmpc(const Nmpc&) = delete;
  Nmpc& operator=(const Nmpc&) = delete;

  [[nodiscard]] int horizon() const override;
  [[nodiscard]] const Plan& Step(const ControllerInput& input) override;
  void Reset() override;
  [[nodiscard]] std::optional<ConstraintViolation> Unsatisfied() const override;

 private:
  class Solver;  // keeps Ipopt's headers in one file
  std::unique_ptr<Solver> solver_;
};

}  // namespace control
