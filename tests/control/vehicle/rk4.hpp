// The classic Runge-Kutta method, for tests that need a trajectory of ẋ = f(x).
#pragma once

namespace control::testing {

// x after `duration` [s], in `steps` equal steps.
template <typename Vector, typename Derivative>
Vector Rk4(Vector x, double duration, int steps, Derivative&& f) {
  const double h = duration / steps;
  for (int i = 0; i < steps; ++i) {
    const Vector k1 = f(x);
    const Vector k2 = f(Vector(x + h / 2.0 * k1));
    const Vector k3 = f(Vector(x + h / 2.0 * k2));
    const Vector k4 = f(Vector(x + h * k3));
    x += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
  }
  return x;
}

}  // namespace control::testing
