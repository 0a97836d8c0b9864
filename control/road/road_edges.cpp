#include "control/road/road_edges.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace control {
namespace {

constexpr double kCell = 0.5;  // [m]

RoadBounds Narrower(const RoadBounds& a, const RoadBounds& b) {
  return {.left = std::min(a.left, b.left), .right = std::max(a.right, b.right)};
}

double WidestOf(std::span<const RoadSample> samples) {
  double widest = 0.0;
  for (const auto& [s, bounds] : samples) widest = std::max({widest, bounds.left, -bounds.right});
  return widest;
}

void Require(bool holds, std::size_t sample, const char* text) {
  if (!holds) throw std::invalid_argument("road sample " + std::to_string(sample) + ": " + text);
}

}  // namespace

RoadEdges::RoadEdges(const RoadBounds& everywhere)
    : samples_{{.s = 0.0, .bounds = everywhere}}, widest_(WidestOf(samples_)) {}

RoadEdges::RoadEdges(std::span<const RoadSample> samples)
    : samples_(samples.begin(), samples.end()), widest_(WidestOf(samples)) {
  if (samples_.empty()) throw std::invalid_argument("no road samples");
  for (std::size_t k = 0; k < samples_.size(); ++k) {
    const auto& [s, bounds] = samples_[k];
    Require(std::isfinite(s) && std::isfinite(bounds.left) && std::isfinite(bounds.right), k,
            "a value is not finite");
    Require(bounds.left > bounds.right, k, "the left edge must be left of the right one");
    Require(k == 0 || s > samples_[k - 1].s, k, "s must be above that of its predecessor");
  }
  const double begin = samples_.front().s;
  std::size_t last = 0;
  for (std::size_t cell = 0; begin + static_cast<double>(cell) * kCell < samples_.back().s; ++cell) {
    while (samples_[last + 1].s <= begin + static_cast<double>(cell) * kCell) ++last;
    cells_.push_back(last);
  }
}

std::size_t RoadEdges::Before(double s) const {
  const double along = s - samples_.front().s;
  std::size_t k = cells_[std::min(static_cast<std::size_t>(along / kCell), cells_.size() - 1)];
  while (samples_[k + 1].s <= s) ++k;
  return k;
}

RoadBounds RoadEdges::At(double s) const {
  if (!(s > samples_.front().s)) return samples_.front().bounds;
  if (s >= samples_.back().s) return samples_.back().bounds;
  const std::size_t k = Before(s);
  const RoadSample &from = samples_[k], &to = samples_[k + 1];
  const double share = std::clamp((s - from.s) / (to.s - from.s), 0.0, 1.0);
  return {.left = std::lerp(from.bounds.left, to.bounds.left, share),
          .right = std::lerp(from.bounds.right, to.bounds.right, share)};
}

RoadBounds RoadEdges::Narrowest(double from, double to) const {
  if (samples_.size() == 1) return samples_.front().bounds;
  RoadBounds narrowest = Narrower(At(from), At(to));
  if (!(to > samples_.front().s) || from >= samples_.back().s) return narrowest;
  // Between two samples, the edges are straight.
  std::size_t k = from < samples_.front().s ? 0 : Before(from) + 1;
  for (; k < samples_.size() && samples_[k].s < to; ++k) narrowest = Narrower(narrowest, samples_[k].bounds);
  return narrowest;
}

RoadEdges RoadEdges::Inset(double width) const {
  RoadEdges inset = *this;
  for (RoadSample& sample : inset.samples_) {
    sample.bounds.left -= width;
    sample.bounds.right += width;
  }
  inset.widest_ = WidestOf(inset.samples_);
  return inset;
}

}  // namespace control
