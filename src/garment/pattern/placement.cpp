#include "garment/pattern/placement.h"

#include <algorithm>
#include <cmath>

#include "geometry/geometry.h"
#include "text/error.h"

namespace mssim {
namespace {

/// How far the body stands out at the heights of a panel, m. Not less than the body itself anywhere, and
/// even: the largest within 5 cm up and down, then its mean over as much.
class Profile {
 public:
  Profile(const std::string& panel, const std::function<double(double)>& depth, double sign, double lowest,
          double highest)
      : start_(lowest - 2 * window * step) {
    const auto count = static_cast<std::size_t>(std::ceil((highest - start_) / step)) + 2 * window + 2;
    std::vector<double> raw(count);
    for (std::size_t i = 0; i < count; ++i) {
      const double height = std::clamp(start_ + static_cast<double>(i) * step, lowest, highest);
      raw[i] = sign * depth(height);
      if (!std::isfinite(raw[i]))
        throw InputError(panel + ": the body has the depth " + shown(raw[i]) + " m at the height " +
                         shown(height) + " m; give a body that reaches along the whole panel");
    }
    std::vector<double> widest(count);
    over_windows(raw,
                 [&](std::size_t i, auto begin, auto end) { widest[i] = *std::max_element(begin, end); });
    values_.resize(count);
    over_windows(widest, [&](std::size_t i, auto begin, auto end) {
      double sum = 0;
      for (auto value = begin; value != end; ++value) sum += *value;
      values_[i] = sum / static_cast<double>(end - begin);
    });
  }

  double at(double height) const {
    const double place = (height - start_) / step;
    const auto i = static_cast<std::size_t>(place);
    return values_[i] + (place - static_cast<double>(i)) * (values_[i + 1] - values_[i]);
  }

 private:
  static constexpr double step = 0.0025;     // m
  static constexpr std::size_t window = 20;  // steps to each side

  template <class Visit>
  static void over_windows(const std::vector<double>& values, Visit visit) {
    for (std::size_t i = 0; i < values.size(); ++i)
      visit(i, values.begin() + static_cast<std::ptrdiff_t>(i - std::min(i, window)),
            values.begin() + static_cast<std::ptrdiff_t>(std::min(i + window + 1, values.size())));
  }

  double start_;
  std::vector<double> values_;
};

/// A point of the bent panel relative to its axis.
struct BentPoint {
  double sideways;  ///< m
  double back;      ///< m, towards the body
};

/// Where the bend takes a point that is `along` from the axis on the flat panel. Where it has come
/// `most_back` towards the body, the panel runs straight on.
BentPoint bent(double along, double radius, double most_back) {
  const double steepest = std::acos(std::max(-1.0, 1 - most_back / radius));
  const double angle = std::clamp(along / radius, -steepest, steepest);
  return {radius * std::sin(angle) + (along - radius * angle), radius * (1 - std::cos(angle))};
}

}  // namespace

std::vector<Vec3d> place_panel(const std::string& panel, const PanelMesh& mesh,
                               const PanelPlacement& placement, const BodyDepth& body) {
  if (!(placement.distance > 0 && placement.radius > 0))
    throw InputError(panel + ": it cannot be placed " + shown(placement.distance) +
                     " m from the body, bent with a radius of " + shown(placement.radius) +
                     " m; give positive lengths");
  const auto [lowest, highest] = std::minmax_element(
      mesh.nodes.begin(), mesh.nodes.end(), [](const Vec3d& a, const Vec3d& b) { return a.y < b.y; });
  // Seen from outside, a panel behind the body runs against x.
  const double outwards = placement.behind ? -1 : 1;
  const Profile profile(panel, placement.behind ? body.back : body.front, outwards, lowest->y, highest->y);
  std::vector<Vec3d> placed;
  placed.reserve(mesh.nodes.size());
  for (const Vec3d& node : mesh.nodes) {
    const double axis = placement.axis(node.y);
    const bool looks_inwards = outwards * node.x * axis < 0;
    constexpr double everywhere = 2;  // radii: the whole circle
    const BentPoint point =
        bent(node.x, placement.radius,
             looks_inwards ? 2.0 / 3 * placement.distance : everywhere * placement.radius);
    placed.push_back(rounded({axis + outwards * point.sideways, node.y,
                              outwards * (profile.at(node.y) + placement.distance - point.back)}));
  }
  return placed;
}

}  // namespace mssim
