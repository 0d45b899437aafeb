#include "free_loop.hpp"

#include <cmath>

#include "../../engine_file/following_springs.hpp"
#include "../../files/units.hpp"
#include "../../loops/run_limits.hpp"
#include "../../loops/valve_tick_limit.hpp"

namespace crankloop::program {

double in_cycle_deg(double angle_deg) noexcept {
  const double deg = angle_deg - 720 * std::floor(angle_deg / 720);
  return deg < 720 ? deg : 0;
}

template <class Real, class S>
FreeLoop<Real, S>::FreeLoop(const EngineFile& file, const EngineDefinition& definition, const FreeOperation& operation)
    : tick_s_{operation.tick_s} {
  require_ticks(operation.seconds / tick_s_, tick_s_, "or fewer --seconds");
  Status status = tables_->build(with_springs_that_follow(definition), {tick_s_});
  if (!status.ok()) throw explain_tabulate(file, status, tick_s_, {});
  require_speed(operation.from_rpm, static_cast<double>(tables_->tables().drive->speed_limit_rad_s), tick_s_,
                definition.crank);
  status = engine_.init(tables_->tables());
  if (!status.ok()) throw file.explain(status);
  const double speed_rad_s = operation.from_rpm / kRpmPerRad_s;
  status = engine_.restore(turning_at<Real, S>(engine_.state(), static_cast<Real>(speed_rad_s)));
  if (!status.ok()) throw file.explain(status);
  if constexpr (detail::Needs<S>::gas) {
    tell(input_, operation.gas);
  } else {
    input_.load_ratio = static_cast<Real>(operation.load_ratio);
  }
  input_.starter = operation.starter ? 1 : 0;
  input_.cut_cylinders = operation.cut_cylinders;
  input_.wheel_faults = operation.wheel_faults;
  shape_ = detail::shape_of<Real, S>(tables_->tables());
  if (operation.schedule) schedule_.emplace(*operation.schedule);
  get_inputs(input_, shape_, inputs_.data());
  state_.speed_rad_s = static_cast<double>(engine_.state().speed_rad_s);
}

template <class Real, class S>
const typename FreeLoop<Real, S>::Output& FreeLoop<Real, S>::step() noexcept {
  before_ = state_;
  if (schedule_) {
    schedule_->at(state_.time_s, inputs_.data());
    set_inputs(input_, shape_, inputs_.data());
  }
  const std::uint64_t phase_before = engine_.state().phase.units();
  const Output& out = engine_.step(input_);
  const std::uint64_t phase = out.crank.units();
  const bool forward = static_cast<std::int64_t>(phase - phase_before) >= 0;
  if (forward && phase < phase_before) ++cycles_;
  if (!forward && phase > phase_before) --cycles_;
  ++ticks_;
  state_.time_s = static_cast<double>(ticks_) * tick_s_;
  state_.angle_deg = static_cast<double>(cycles_) * 720 + static_cast<double>(phase) * kDegPerUnit;
  state_.speed_rad_s = static_cast<double>(out.speed_rad_s);
  state_.acceleration_rad_s2 = static_cast<double>(out.acceleration_rad_s2);
  state_.torque_Nm = static_cast<double>(out.torque_Nm);
  const double turned_rad = (state_.angle_deg - before_.angle_deg) * kRadPerDeg;
  state_.work_J += static_cast<double>(out.mean_torque_Nm) * turned_rad;
  state_.external_J += static_cast<double>(input_.external_torque_Nm) * turned_rad;
  return out;
}

template class FreeLoop<float, scenes::FreeRunning>;
template class FreeLoop<double, scenes::FreeRunning>;
template class FreeLoop<float, scenes::BreathingFree>;
template class FreeLoop<double, scenes::BreathingFree>;

}  // namespace crankloop::program
