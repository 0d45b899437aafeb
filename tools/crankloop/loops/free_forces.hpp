// Free forces of an engine with its counterweights and balance shafts, and what they do to its mounts.
//
// What belongs here: sums of turning forces, at constant speed. What does not: the engine's own orders
// (crankloop/tabulate/summary.hpp). Equations: docs/model.md "Balance".
#pragma once

#include <vector>

#include <crankloop/tabulate/summary.hpp>

#include "../engine_file/balancer.hpp"

namespace crankloop::program {

using TurningForce = detail::RotatingVector<double>;

/// What the balancers that turn `order` times per turn of the crankshaft add, about the middle of the crankshaft.
[[nodiscard]] TurningForce balancer_order(const EngineDefinition& engine, const std::vector<Balancer>& balancers,
                                          int order);

/// Everything of an order: reciprocating masses, rotating ones where it is the first, balancers.
[[nodiscard]] TurningForce free_force(const EngineDefinition& engine, const std::vector<Balancer>& balancers,
                                      int order);

/// Free forces at one engine angle, N and Nm.
struct FreeLoad {
  double up_N = 0;
  double lateral_N = 0;
  double pitch_Nm = 0;
  double yaw_Nm = 0;
};

inline constexpr int kHighestFreeOrder = 6;

/// free_force() of orders 1 to kHighestFreeOrder, added up at any engine angle.
class FreeForces {
 public:
  FreeForces(const EngineDefinition& engine, const std::vector<Balancer>& balancers);
  [[nodiscard]] FreeLoad at(double engine_deg, double speed_rad_s) const;

 private:
  TurningForce orders_[kHighestFreeOrder];
};

/// Four feet at the corners of a rectangle about the middle of the crankshaft, in the plane of its axis.
struct Mounts {
  double width_m = 0;   ///< between the feet of either side
  double length_m = 0;  ///< between the front pair, at the end of the lowest position, and the rear pair
};
inline constexpr int kFeet = 4;

/// A foot by its place: at the front or the rear, on the side of positive lateral (plus) or the other (minus).
struct Foot {
  const char* name;
  int lateral;  ///< -1, 1
  int along;    ///< -1: front, 1: rear
};
inline constexpr Foot kFeetOf[kFeet] = {
    {"front_plus", 1, -1}, {"front_minus", -1, -1}, {"rear_plus", 1, 1}, {"rear_minus", -1, 1}};

struct FootForce {
  double up_N = 0;
  double lateral_N = 0;
};

/// What a foot presses on its mount: a stiff engine on four equal mounts, without its weight. `tilting_Nm` is the
/// moment on the engine block about the crankshaft's axis, positive in the sense of rotation.
[[nodiscard]] FootForce foot_force(const Mounts& mounts, const Foot& foot, const FreeLoad& load, double tilting_Nm);

}  // namespace crankloop::program
