#include "valve_loop.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <crankloop/tick/step.hpp>

#include "../engine_file/gas_order.hpp"
#include "../files/number.hpp"
#include "../files/units.hpp"
#include "run_limits.hpp"
#include "textbook_valve.hpp"
#include "valve_tick_limit.hpp"

template class crankloop::Engine<float, crankloop::program::OneValve>;
template class crankloop::Engine<double, crankloop::program::OneValve>;

namespace crankloop::program {
namespace {

Crank any_crank() {
  Crank crank;
  crank.bore_m = 0.1;
  crank.crank_radius_m = 0.05;
  crank.rod_length_m = 0.2;
  return crank;
}

std::uint64_t whole_ticks(double ticks) {
  return static_cast<std::uint64_t>(std::max(1.0, std::ceil(ticks - kHairOfATick)));
}

/// The definition is valid, so that a refusal here is a defect of the program.
void require(const Status& status) {
  if (!status.ok()) throw std::logic_error(std::string(status.field) + " " + describe(status.reason));
}

void require_ticks(double ticks, double tick_s) {
  if (ticks <= kMaxTicks) return;
  throw UsageError("that would take " + brief(ticks) + " ticks of " + brief(tick_s * 1e6) + " us, at most " +
                   brief(kMaxTicks) + " are allowed: take a longer --tick-us, fewer --cycles or a higher --rpm");
}

/// Where a cycle ends, in cam degrees from the start of the lobe: the middle of the base circle, as the tick sees it.
template <class Real>
double middle_of_base_circle_deg(const detail::LiftCurve<Real>& curve) {
  return (static_cast<double>(curve.segments) + kDegreesPerTurn) / 2;
}

}  // namespace

double ticks_per_cycle(double speed_rpm, double tick_s) noexcept { return 120 / (std::abs(speed_rpm) * tick_s); }

// ---- the train -----------------------------------------------------------------------------------------------------

LoneValve::LoneValve(const EngineFile& file, const std::string& name) : file_{file}, train_{file.train(name)} {
  for (const char* kind : {"cam ", "rocker ", "valve "}) {
    if (file.has(kind + name)) continue;
    throw InputError(file.path() + ": section [" + kind + name + "] is missing; this command needs it");
  }
  if (file.has("crank")) {
    definition_.crank = file.definition().crank;
    definition_.crank.max_speed_rad_s = 0;  // no limit: the sweep goes beyond the engine's maximum
    // Of an engine with gas exchange a single valve has no cylinder pressure, so no gas force.
    if (train_.definition.valve.head_area_m2 > 0 && !breathes(file.definition()))
      definition_.pressure = file.definition().pressure;
  } else {
    definition_.crank = any_crank();
  }
  definition_.masses.piston_kg = 1;
  definition_.train_count = 1;
  definition_.trains[0] = train_.definition;
  definition_.contacts[0] = train_.contact;
  const auto lift = std::make_shared<ValveLift>();
  if (const Status refused = lift->init(train_.definition.cam, train_.definition.rocker); !refused.ok()) {
    throw file.explain(refused, train_, lift->failed_at_deg());
  }
  lift_ = lift;
}

LoneValve LoneValve::with(const Valve& valve) const {
  LoneValve other = *this;
  other.definition_.trains[0].valve = valve;
  return other;
}

detail::ValveBody<double> LoneValve::body() const noexcept { return valve_body(valve(), *lift_); }

StaticRedline LoneValve::static_redline() const noexcept { return crankloop::static_redline(lift(), body()); }

double LoneValve::cam_deg(double since_opening_deg) const noexcept {
  return since_opening_deg + lift_->opens_rad() * kDegPerRad;
}

// ---- the loop ------------------------------------------------------------------------------------------------------

template <class Real>
ValveLoop<Real>::ValveLoop(const LoneValve& valve, double tick_s, const ValveMethod& method)
    : full_lift_deg_{valve.definition().trains[0].cam.full_lift_deg},
      is_textbook_{method.textbook},
      head_area_m2_{valve.valve().head_area_m2},
      crankcase_Pa_{valve.definition().pressure.crankcase_Pa},
      storage_{std::make_shared<Storage>()} {
  const EngineDefinition& definition = valve.definition();
  if (const Status refused = storage_->build(definition, {tick_s, method.stepping}, &report_); !refused.ok()) {
    if (refused.field == std::string("options.tick_s")) {
      throw tick_too_long(valve.file(), valve.train(), valve.valve(), tick_s, method.stepping);
    }
    throw valve.file().explain({refused.reason, -1, refused.field}, valve.train(), valve.lift().failed_at_deg());
  }
  if (is_textbook_ && head_area_m2_ > 0) {
    const auto diagram = std::make_shared<IndicatorDiagram>();
    require(diagram->init(definition.crank, definition.pressure));
    diagram_ = diagram;
  }
}

template <class Real>
Phase ValveLoop<Real>::turned(double speed_rpm) const noexcept {
  const Real speed_rad_s = static_cast<Real>(speed_rpm * kPi / 30);
  return Phase::from_cycles(speed_rad_s * tables().drive->cycles_per_tick_per_rad_s);
}

template <class Real>
double ValveLoop<Real>::deg_per_tick(double speed_rpm) const noexcept {
  return turned(speed_rpm).template signed_cycles<double>() * kDegreesPerTurn;
}

template <class Real>
void ValveLoop<Real>::start(double speed_rpm, double cam_deg, std::uint64_t ticks) {
  const detail::Drive<Real>& drive = *tables().drive;
  input_.speed_rad_s = static_cast<Real>(speed_rpm * kPi / 30);
  if (!(std::abs(input_.speed_rad_s) <= drive.speed_limit_rad_s)) {
    const double limit_rpm = std::floor(static_cast<double>(drive.speed_limit_rad_s) * 30 / kPi);
    throw UsageError(brief(speed_rpm) + " rpm is too fast for a tick of " +
                     brief(static_cast<double>(drive.tick_s) * 1e6) + " us: at most one revolution per tick, here " +
                     brief(limit_rpm) + " rpm");
  }
  const Phase full_lift = Phase::from_cycles(full_lift_deg_ / kDegreesPerCycle);
  const Phase there = full_lift + Phase::from_cycles(cam_deg / kDegreesPerTurn);
  require(engine_.init(tables(), there - Phase{ticks * turned(speed_rpm).units()}));
  textbook_ = {};
  textbook_.valve.regime = kSeatOn;
  faults_ = 0;
  start_cam_deg_ = cam_deg;
  deg_per_tick_ = deg_per_tick(speed_rpm);
  ticks_ = -static_cast<std::int64_t>(ticks);
}

template <class Real>
void ValveLoop<Real>::step() noexcept {
  const Phase before = engine_.state().phase;
  faults_ |= engine_.step(input_).faults;
  if (is_textbook_) textbook_step(before, engine_.state().phase);
  ++ticks_;
}

/// The engine only counts the angle; its valve is not used.
template <class Real>
void ValveLoop<Real>::textbook_step(Phase before, Phase after) noexcept {
  const CamSpan cam{since_opening(before), since_opening(after)};
  textbook_.cam_deg_s = cam.turned_deg<Real>() * tables().drive->per_tick_s;
  textbook_.gas_N = Real{0};
  if (diagram_) {
    const double engine_deg = static_cast<double>(after.units()) * kDegPerUnit;
    textbook_.gas_N = static_cast<Real>((diagram_->full_Pa(engine_deg) - crankcase_Pa_) * head_area_m2_);
  }
  TextbookValve<Real>(motion(), curve()).advance(textbook_.valve, cam, textbook_.gas_N, textbook_.record);
  if (curve().passes_base_circle(cam.from, cam.to)) {
    textbook_.cycle = textbook_.record.finish(Real{kDegreesPerTurn}, textbook_.valve.regime);
  }
}

template <class Real>
ValveTickOutput<Real> ValveLoop<Real>::output() const noexcept {
  const double cam_deg = start_cam_deg_ + static_cast<double>(ticks_) * deg_per_tick_;
  if (!is_textbook_) {
    const auto& out = engine_.output();
    return {cam_deg, out.valve[0][0], out.valve_forces[0][0], out.valve_spring[0][0]};
  }
  const detail::ValveBody<Real>& body = motion().body;
  const detail::ValveState<Real>& valve = textbook_.valve.state;
  const detail::Cell cell = detail::LiftCurve<Real>::cell(since_opening(engine_.state().phase));
  const detail::Lift<Real> cam = curve().read(cell);
  const LiftNow<Real> lift{cam.lift_m, cam.per_deg_m * textbook_.cam_deg_s};
  const Contacts<Real> c(body, valve, lift);
  ValveTickOutput<Real> out{};
  out.cam_deg = cam_deg;
  out.motion = {{std::max(lift.lift_m, Real{0})},
                {valve.lift_m, valve.velocity_m_s},
                {textbook_acceleration(body, valve, lift, textbook_.gas_N)}};
  out.forces.train_N = c.train_force_N();
  out.forces.seat_N = c.seat_force_N();
  out.forces.tip_N = out.forces.train_N - body.rocker_mass_kg * out.motion.acceleration_m_s2;
  const Real ratio =
      cell.degree < curve().segments ? value(curve().rocker_ratio[cell.degree], detail::fraction<Real>(cell)) : Real{0};
  out.forces.cam_N = out.forces.train_N * ratio;
  out.forces.train_compression_m = c.compression_m;
  out.forces.regime = textbook_.valve.regime;
  out.springs.moving_N = out.springs.fixed_N = body.preload_N + body.spring_N_m * valve.lift_m;
  return out;
}

template <class Real>
const ValveCycle<Real>& ValveLoop<Real>::last_cycle() const noexcept {
  return is_textbook_ ? textbook_.cycle : engine_.output().valve_cycle[0][0];
}

template <class Real>
ValveCycle<Real> run_cycles(ValveLoop<Real>& loop, const LoneValve& valve, double speed_rpm, int cycles,
                            const OnValveTick<Real>& on_tick, const std::function<void()>& after_tick) {
  const double tick_s = static_cast<double>(loop.motion().tick_s);
  require_ticks(cycles * ticks_per_cycle(speed_rpm, tick_s), tick_s);
  const double sense = speed_rpm < 0 ? -1 : 1;
  const double deg_per_tick = std::abs(loop.deg_per_tick(speed_rpm));
  const double per_cycle = kDegreesPerTurn / deg_per_tick;
  const std::uint64_t settling = whole_ticks((cycles - 1) * per_cycle);
  loop.start(speed_rpm, -180 * sense, settling);
  const auto step = [&] {
    loop.step();
    if (after_tick) after_tick();
  };
  for (std::uint64_t i = 0; i < settling; ++i) step();
  const auto last = static_cast<std::uint64_t>(per_cycle + kHairOfATick);
  if (on_tick) on_tick(loop.output());
  for (std::uint64_t i = 1; i <= last; ++i) {
    step();
    if (on_tick) on_tick(loop.output());
  }
  // The results of this lobe are there once the cam has passed the middle of the base circle behind it.
  const double middle_deg = valve.cam_deg(middle_of_base_circle_deg(loop.curve()));
  const double behind_deg = sense > 0 ? middle_deg : 360 - middle_deg;
  const std::uint64_t needed = whole_ticks((behind_deg + 180) / deg_per_tick) + 1;
  for (std::uint64_t i = last; i < needed; ++i) step();
  return loop.last_cycle();
}

template <class Real>
double largest_change_of_lift_m(const LoneValve& valve, double speed_rpm, double tick_s, const ValveMethod& method,
                                int cycles, const std::function<void()>& after_tick) {
  const double cycle_s = 120 / std::abs(speed_rpm);
  double per_cycle = std::ceil(cycle_s / tick_s - kHairOfATick);
  if (cycle_s / per_cycle < kShortestTick_s) per_cycle -= 1;
  ValveLoop<Real> before(valve, cycle_s / per_cycle, method);
  const auto ticks = static_cast<std::uint64_t>(per_cycle);
  const auto run = [&](ValveLoop<Real>& loop) {
    loop.step();
    if (after_tick) after_tick();
  };
  before.start(speed_rpm, speed_rpm < 0 ? 180 : -180, static_cast<std::uint64_t>(cycles) * ticks);
  for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(std::max(cycles, 2) - 2) * ticks; ++i) run(before);
  ValveLoop<Real> after = before;
  for (std::uint64_t i = 0; i < ticks; ++i) run(after);
  Real largest{0};
  for (std::uint64_t i = 0; i < ticks; ++i) {
    run(before);
    run(after);
    largest = std::max(largest, std::abs(after.output().motion.lift_m - before.output().motion.lift_m));
  }
  return static_cast<double>(largest);
}

bool gas_acts(const LoneValve& valve) noexcept {
  return valve.valve().head_area_m2 > 0 && !breathes(valve.file().definition()) &&
         valve.definition().pressure.source != PressureSource::none;
}

std::string gas_on_head(const LoneValve& valve) {
  if (gas_acts(valve)) return "with the gas force on the head, full load";
  if (!(valve.valve().head_area_m2 > 0)) return "no gas force: head_area_mm2 is 0";
  if (breathes(valve.file().definition())) return "no gas force: for an engine with gas exchange use `crankloop run`";
  return "no gas force: the file has no [pressure] source";
}

template class ValveLoop<float>;
template class ValveLoop<double>;
template ValveCycle<float> run_cycles(ValveLoop<float>&, const LoneValve&, double, int, const OnValveTick<float>&,
                                      const std::function<void()>&);
template ValveCycle<double> run_cycles(ValveLoop<double>&, const LoneValve&, double, int, const OnValveTick<double>&,
                                       const std::function<void()>&);
template double largest_change_of_lift_m<float>(const LoneValve&, double, double, const ValveMethod&, int,
                                                const std::function<void()>&);
template double largest_change_of_lift_m<double>(const LoneValve&, double, double, const ValveMethod&, int,
                                                 const std::function<void()>&);

}  // namespace crankloop::program
