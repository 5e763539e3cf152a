#include "garment/layers/cloth_cloth.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "text/text.h"

namespace mssim {
namespace {

void require(bool good, const char* what, double value, const char* wanted) {
  if (!good)
    throw std::invalid_argument(
        fmt::format("cloth-cloth collision: {} is {}, give {}", what, decimal(value), wanted));
}

void validate(const ClothClothSettings& settings) {
  const auto not_negative = [](double value) { return value >= 0 && std::isfinite(value); };
  const auto thickness = static_cast<float>(settings.thickness);  // in the precision of the search
  require(thickness > 0 && std::isfinite(thickness), "the thickness in metres", settings.thickness,
          "a positive one");
  require(not_negative(settings.friction), "the friction", settings.friction, "a coefficient of at least 0");
  require(not_negative(settings.push_speed), "the push speed in m/s", settings.push_speed, "at least 0");
  require(settings.sweeps >= 1, "the number of sweeps", settings.sweeps, "at least 1");
}

}  // namespace

ClothClothCollision::ClothClothCollision(const Garment& garment, std::span<const float> node_mass,
                                         const ClothClothSettings& settings, int threads)
    : settings_((validate(settings), settings)),
      threads_(threads),
      search_(garment, settings.thickness, threads) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (auto* arrays : {&position_, &velocity_}) (*arrays)[axis].resize(node_mass.size());
  inverse_mass_.reserve(node_mass.size());
  for (const float mass : node_mass) {
    if (!(mass > 0))
      throw std::invalid_argument(
          fmt::format("cloth-cloth collision: node {} has a mass of {} kg, give it a positive one, or an "
                      "infinite one to pin it",
                      inverse_mass_.size(), decimal(mass)));
    inverse_mass_.push_back(1 / mass);
  }
}

void ClothClothCollision::respond(double dt) {
  contacts_ = search_.find({position_[0], position_[1], position_[2]});
  for (std::uint32_t sweep = 0; sweep < settings_.sweeps; ++sweep)
    for (const ClothContact& contact : contacts_) stop_approach(contact);
  const auto farthest = static_cast<float>(settings_.push_speed * dt);
  for (const ClothContact& contact : contacts_) push_apart(contact, farthest);
}

void ClothClothCollision::put(std::size_t node, const NodeState& state) {
  const auto& [x, v] = state;
  position_[0][node] = x.x, position_[1][node] = x.y, position_[2][node] = x.z;
  velocity_[0][node] = v.x, velocity_[1][node] = v.y, velocity_[2][node] = v.z;
}

NodeState ClothClothCollision::at(std::size_t node) const {
  return {{position_[0][node], position_[1][node], position_[2][node]},
          {velocity_[0][node], velocity_[1][node], velocity_[2][node]}};
}

/// The node's value less that of the triangle's nearest point.
Vec3<float> ClothClothCollision::difference(const ClothContact& contact, const Arrays& of) {
  const auto at = [&](std::uint32_t node) { return Vec3<float>{of[0][node], of[1][node], of[2][node]}; };
  const Vec3<float> own = at(contact.node);
  Vec3<float> sum;
  // Differences first, because the rounding errors of small numbers are small.
  for (std::size_t i = 0; i < 3; ++i) sum += contact.weight[i] * (own - at(contact.triangle[i]));
  return sum;
}

void ClothClothCollision::stop_approach(const ClothContact& contact) {
  const float inverse_mass = inverse_mass_of(contact);
  if (inverse_mass == 0) return;
  const Vec3<float> relative = difference(contact, velocity_);
  const float along = dot(relative, contact.normal);
  if (along >= 0) return;
  const Vec3<float> across = relative - along * contact.normal;
  const float sliding = std::sqrt(dot(across, across));
  const float slowed = -static_cast<float>(settings_.friction) * along;  // m/s
  const float kept = sliding > slowed ? slowed / sliding : 1;            // fraction of `across` that is lost
  move(contact, velocity_, (-1 / inverse_mass) * (along * contact.normal + kept * across));
}

void ClothClothCollision::push_apart(const ClothContact& contact, float farthest) {
  const float inverse_mass = inverse_mass_of(contact);
  if (inverse_mass == 0) return;
  // The current gap: other contacts may have moved the same nodes.
  const float gap = dot(difference(contact, position_), contact.normal);
  const float wanted = std::min(static_cast<float>(settings_.thickness), contact.gap + farthest);
  if (gap >= wanted) return;
  move(contact, position_, ((wanted - gap) / inverse_mass) * contact.normal);
}

float ClothClothCollision::inverse_mass_of(const ClothContact& contact) const {
  float sum = inverse_mass_[contact.node];
  for (std::size_t i = 0; i < 3; ++i)
    sum += contact.weight[i] * contact.weight[i] * inverse_mass_[contact.triangle[i]];
  return sum;
}

void ClothClothCollision::move(const ClothContact& contact, Arrays& of, const Vec3<float>& impulse) const {
  const auto add = [&](std::uint32_t node, float weight) {
    const Vec3<float> change = weight * inverse_mass_[node] * impulse;
    of[0][node] += change.x;
    of[1][node] += change.y;
    of[2][node] += change.z;
  };
  add(contact.node, 1);
  for (std::size_t i = 0; i < 3; ++i) add(contact.triangle[i], -contact.weight[i]);
}

}  // namespace mssim
