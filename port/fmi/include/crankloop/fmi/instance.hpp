// One functional mock-up unit (FMU) at work: its variables, its life cycle, its time. The same for FMI 2.0 and
// 3.0, whose functions (fmi/fmi2_exports.inc, fmi/fmi3_exports.inc) only translate.
//
// What belongs here: what an importer's calls do. What does not: its state as bytes (fmi/kept.hpp), and where tables
// come from, which is the Supply's:
//
//     using Real, Scene
//     static constexpr std::size_t kMaxParameters      engine numbers that may be set before the start
//     bool open(const char* resources, Message& why)    once; from then on the following answer
//     EngineShape shape() const;  double tick_s() const;  std::uint64_t identity() const;  std::size_t parameters()
//     const Variable parameter(std::size_t) const;  double parameter_default(std::size_t) const
//     void set_start_values(Input<double, Scene>&, double& speed_rad_s) const    other than 0 and Input's own
//     const Tables<Real, Scene>* build(const double* parameters, Message& why)   null: refused
//
// Nothing is allocated here: an instance lies in one piece of memory, a stored state in another.
#pragma once

#include <cmath>
#include <cstring>
#include <type_traits>

#include <crankloop/version.h>

#include <crankloop/fmi/kept.hpp>
#include <crankloop/variable_values.hpp>

namespace crankloop::fmi {

/// `event`: an output that changes at an edge or fault, and in no step between.
enum class Role : std::uint8_t { independent, input, parameter, output, event, constant };

/// What get and set need of a variable.
struct Slot {
  std::uint32_t offset;  ///< from the start of the instance
  Storage storage;
  VariableKind kind;
  Role role;
};

template <class Supply>
class Instance {
 public:
  using Real = typename Supply::Real;
  using S = typename Supply::Scene;

  /// Once, in new memory. False: `why` states what is wrong with the resources.
  bool open(const char* resources, Message& why) noexcept {
    if (!supply_.open(resources, why)) return false;
    shape_ = supply_.shape();
    tick_s_ = supply_.tick_s();
    std::uint32_t next = 0;
    each([this, &next](Role role, const Variable& variable, auto& value) {
      using Value = std::remove_cv_t<std::remove_reference_t<decltype(value)>>;
      const auto* at = reinterpret_cast<const unsigned char*>(&value);
      const auto offset = static_cast<std::uint32_t>(at - reinterpret_cast<const unsigned char*>(this));
      slots_[next++] = {offset, kStorageOf<Value>, variable.kind, role};
    });
    variables_ = next;
    make_token();
    reset();
    return true;
  }

  [[nodiscard]] const Token& token() const noexcept { return token_; }
  [[nodiscard]] double tick_s() const noexcept { return tick_s_; }
  [[nodiscard]] Stage stage() const noexcept { return kept_.stage; }
  [[nodiscard]] double time_s() const noexcept { return kept_.time_s; }
  [[nodiscard]] std::uint32_t faults() const noexcept { return kept_.faults; }
  [[nodiscard]] std::uint32_t variables() const noexcept { return variables_; }

  /// All variables, visit(role, variable, value): a variable's number in this order is its value reference.
  template <class Visit>
  void each(Visit&& visit) noexcept {
    visit(Role::independent, real("time", "Time"), kept_.time_s);
    double* input = kept_.inputs;
    Input<double, S> shown;
    each_input<S>([&](const Variable& variable, auto&) { visit(Role::input, variable, *input++); }, shown, shape_);
    if constexpr (S::crank != CrankGiven::phase) {
      visit(Role::parameter, real("start.crank_deg", "Crank angle at the start").within(0, 720), kept_.start_crank_deg);
    }
    if constexpr (detail::Needs<S>::crank_dynamics) {
      const double limit_rad_s = shape_.speed_limit_rad_s;
      visit(Role::parameter, real("start.speed_rad_s", "Crank speed at the start").within(-limit_rad_s, limit_rad_s),
            kept_.start_speed_rad_s);
    }
    for (std::size_t i = 0; i < supply_.parameters(); ++i)
      visit(Role::parameter, supply_.parameter(i), kept_.parameters[i]);
    each_output<S>([&visit](const Variable& variable, auto& value) { visit(Role::output, variable, value); },
                   engine_.state(), engine_.output(), shape_);
    constexpr WheelNames kHealthy{"trigger[#].level", "trigger[#].edges", "trigger[#].edge_s[#]",
                                  "trigger[#].edge_rises[#]"};
    for (std::uint32_t i = 0; i < shape_.wheels; ++i) each_of_wheel(visit, kHealthy, i, kept_.wheels[i]);
    if constexpr (detail::Needs<S>::faulty_wheels) {
      constexpr WheelNames kFaulty{"faulty_trigger[#].level", "faulty_trigger[#].edges", "faulty_trigger[#].edge_s[#]",
                                   "faulty_trigger[#].edge_rises[#]"};
      for (std::uint32_t i = 0; i < shape_.wheels; ++i)
        each_of_wheel(visit, kFaulty, i, kept_.wheels[Kept<Supply>::kMaxWheels + i]);
    }
    visit(Role::event, whole("faults", "Fault bits of the last communication step, or-ed"), kept_.faults);
    visit(Role::event, whole("fault_ticks", "Ticks with a fault bit since the start"), kept_.fault_ticks);
    visit(Role::constant, real("tick_s", "Length of a tick"), tick_s_);
  }

  // ---- get and set: `reference` is a value reference ---------------------------------------------------------

  [[nodiscard]] bool has(std::uint32_t reference, VariableKind kind) const noexcept {
    return reference < variables_ && slots_[reference].kind == kind;
  }
  /// Whether it may be set at this stage.
  [[nodiscard]] bool takes(std::uint32_t reference, VariableKind kind) const noexcept {
    if (!has(reference, kind)) return false;
    const Role role = slots_[reference].role;
    return role == Role::input || (role == Role::parameter && kept_.stage < Stage::stepping);
  }

  /// Of a reference that has the kind.
  [[nodiscard]] double number(std::uint32_t reference) const noexcept {
    const Slot& slot = slots_[reference];
    auto* at = const_cast<unsigned char*>(reinterpret_cast<const unsigned char*>(this)) + slot.offset;
    double number = 0;
    with_value(slot.storage, at, [&number](auto& value) { number = as_number(value); });
    return number;
  }
  /// Of a reference that takes it. All that may be set is kept in double.
  void set_number(std::uint32_t reference, double value) noexcept {
    kept_.input_is_old = true;
    std::memcpy(reinterpret_cast<unsigned char*>(this) + slots_[reference].offset, &value, sizeof value);
  }

  // ---- life cycle: false is a refusal, nothing changed, `why` has the reason ---------------------------------

  bool set_start(double start_s, Message& why) noexcept {
    if (!finite(start_s)) return why.say("the start time is not finite"), false;
    kept_.start_s = kept_.time_s = start_s;
    return true;
  }
  void begin_initialization() noexcept { kept_.stage = Stage::initializing; }

  bool finish_initialization(Message& why) noexcept {
    const auto is_within = [&why](const char* name, double x, double least, double most) {
      return detail::within(x, least, most) || (why.say("%s must be %g to %g, not %g", name, least, most, x), false);
    };
    const double limit_rad_s = shape_.speed_limit_rad_s;
    if (!is_within("start.crank_deg", kept_.start_crank_deg, 0, 720)) return false;
    if (!is_within("start.speed_rad_s", kept_.start_speed_rad_s, -limit_rad_s, limit_rad_s)) return false;
    if (!start_engine(why)) return false;
    kept_.stage = Stage::stepping;
    return true;
  }

  void terminate() noexcept { kept_.stage = Stage::terminated; }

  /// As new; what the importer set is forgotten.
  void reset() noexcept {
    engine_ = Engine<Real, S>{};
    kept_ = Kept<Supply>{};
    Input<double, S> in;
    supply_.set_start_values(in, kept_.start_speed_rad_s);
    each_input<S>([to = kept_.inputs](const Variable&, auto& value) mutable { *to++ = as_number(value); }, in, shape_);
    for (std::size_t i = 0; i < supply_.parameters(); ++i) kept_.parameters[i] = supply_.parameter_default(i);
  }

  /// Advances to time_s + step_s by whole ticks. Tick k ends at start + k tick, however the importer divides the time,
  /// and whatever its sums round to: a thousandth of a tick is tolerated. False: refused, see say_why_no_step().
  [[gnu::always_inline]] bool step(double time_s, double step_s) noexcept {
    constexpr double kForgiven = 1e-3;
    const double end_s = time_s + step_s;
    const double due = (end_s - kept_.start_s) / tick_s_ + kForgiven - ticks_run();
    if (!(step_s > 0 && begins_at_end(time_s) && due < kMaxTicks + 1)) return false;
    kept_.faults = 0;
    if (due >= 1) run(static_cast<std::uint32_t>(due));
    kept_.time_s = end_s;
    return true;
  }
  [[gnu::cold]] void say_why_no_step(double time_s, double step_s, Message& why) const noexcept {
    if (!(step_s > 0 && finite(step_s))) return why.say("a step of %g s: it must be above 0 and finite", step_s);
    if (!begins_at_end(time_s))
      return why.say("a step from %.17g s, where the last one ended at %.17g s", time_s, kept_.time_s);
    why.say("a step of %.0f ticks: at most %.0f are run", step_s / tick_s_, kMaxTicks);
  }

  // ---- state as bytes -------------------------------------------------------------------------------------------

  static constexpr std::size_t kStateBytes = Kept<Supply>::count_bytes();

  void save(unsigned char* bytes) const noexcept { kept_.save(bytes, token_, engine_); }
  bool check(const unsigned char* bytes, Message& why) const noexcept { return kept_.check(bytes, token_, why); }

  /// Goes on from it. Refused: as it was.
  bool load(const unsigned char* bytes, Message& why) noexcept {
    Kept<Supply> kept;
    Output<Real, S> output{};
    if (!kept.read(bytes, token_, output, why)) return false;
    if (kept.stage < Stage::stepping) {
      engine_ = Engine<Real, S>{};
    } else if (!load_engine(bytes, kept.parameters, output, why)) {
      return false;
    }
    kept_ = kept;
    return true;
  }

 private:
  static constexpr double kMaxTicks = 1e7;
  static constexpr std::uint32_t kForm = 1;
  static constexpr std::size_t kHeaderBytes = 28;
  static constexpr std::size_t kMaxVariables = 6 + Kept<Supply>::kCount.inputs + Kept<Supply>::kMaxParameters +
                                               Kept<Supply>::kCount.outputs +
                                               Kept<Supply>::kSignals * (2 + 2 * kEdgesShown);

  bool start_engine(Message& why) noexcept {
    const Tables<Real, S>* tables = supply_.build(kept_.parameters, why);
    if (tables == nullptr) return false;
    if (const Status refused = engine_.init(*tables, phase_of(kept_.start_crank_deg)); !refused.ok())
      return why.say("the engine does not start: %s, reason %d", refused.field, static_cast<int>(refused.reason)),
             false;
    if constexpr (detail::Needs<S>::crank_dynamics) {
      // An engine's own state is of its own tables.
      (void)engine_.restore(turning_at<Real, S>(engine_.state(), static_cast<Real>(kept_.start_speed_rad_s)));
    }
    return true;
  }

  /// The engine of a saved state, on tables of the parameters it was saved with. Refused: as it was.
  bool load_engine(const unsigned char* bytes, const double* parameters, const Output<Real, S>& output,
                   Message& why) noexcept {
    const Tables<Real, S>* before = engine_.tables();
    const Tables<Real, S>* tables = supply_.build(parameters, why);
    Engine<Real, S> engine;
    bool good = tables != nullptr && engine.init(*tables).ok();
    if (good) {
      good = Kept<Supply>::read(bytes, engine) && engine.restore(engine.state(), output).ok();
      if (!good) why.say("the state of the engine is refused");
    }
    if (good) {
      engine_ = engine;
    } else if (before != nullptr) {
      Message unsaid;  // they were built once
      (void)supply_.build(kept_.parameters, unsaid);
    }
    return good;
  }

  /// Signed: a conversion of one instruction.
  [[nodiscard]] double ticks_run() const noexcept {
    return static_cast<double>(static_cast<std::int64_t>(kept_.ticks));
  }
  /// Whether the last step ended there, within half a tick.
  [[nodiscard]] bool begins_at_end(double time_s) const noexcept {
    return std::fabs(time_s - kept_.time_s) <= tick_s_ / 2;
  }

  /// The first tick of a step in line: most steps have no other.
  [[gnu::always_inline]] void run(std::uint32_t count) noexcept {
    if (kept_.input_is_old) convert_inputs();
    tick();
    if (count > 1) run_on(count - 1);
  }
  [[gnu::noinline]] void run_on(std::uint32_t count) noexcept {
    while (count-- > 0) tick();
  }
  [[gnu::noinline]] void convert_inputs() noexcept {
    each_input<S>([from = kept_.inputs](const Variable&, auto& value) mutable { assign(value, *from++); }, input_,
                  shape_);
    kept_.input_is_old = false;
  }

  [[gnu::always_inline]] void tick() noexcept {
    const auto& out = engine_.step(input_);
    if (out.faults != 0) note_faults(out.faults);
    if constexpr (detail::Needs<S>::any_triggers) {
      for (std::uint32_t w = 0; w < shape_.wheels; ++w) show_signal(out.trigger[w], kept_.wheels[w]);
    }
    if constexpr (detail::Needs<S>::faulty_wheels) {
      for (std::uint32_t w = 0; w < shape_.wheels; ++w)
        show_signal(out.faulty_trigger[w], kept_.wheels[Kept<Supply>::kMaxWheels + w]);
    }
    ++kept_.ticks;
  }
  struct WheelNames {
    const char *level, *edges, *edge_s, *edge_rises;
  };
  template <class Visit>
  static void each_of_wheel(Visit& visit, const WheelNames& names, std::uint32_t i, WheelShown& w) noexcept {
    visit(Role::event, truth(names.level, "Level of the signal").at(i), w.level);
    visit(Role::event, whole(names.edges, "Edges since the start, modulo 2^31").at(i), w.edges);
    for (std::uint32_t e = 0; e < kEdgesShown; ++e)
      visit(Role::event, real(names.edge_s, "Time of an edge; 1 is the newest").at(i, e), w.edge[e].time_s);
    for (std::uint32_t e = 0; e < kEdgesShown; ++e)
      visit(Role::event, truth(names.edge_rises, "Whether it rose").at(i, e), w.edge[e].rises);
  }
  template <class Signal>
  [[gnu::always_inline]] void show_signal(const Signal& signal, WheelShown& shown) noexcept {
    shown.level = signal.level;
    if (signal.edge_count != 0) shown.note(signal, kept_.start_s + ticks_run() * tick_s_);
  }
  [[gnu::noinline]] void note_faults(std::uint32_t faults) noexcept {
    kept_.faults |= faults;
    if (kept_.fault_ticks < kMaxWhole) ++kept_.fault_ticks;
  }

  /// What identifies an FMU: tables, scene, arithmetic, version, tick, and every variable's name in its place.
  void make_token() noexcept {
    detail::Crc32 names;
    each([&names](Role role, const Variable& variable, auto&) {
      for (const char* c = variable.name; *c != '\0'; ++c) names.add(static_cast<unsigned char>(*c));
      names.add(static_cast<std::uint32_t>(role) << 16 | variable.first << 8 | variable.second);
    });
    detail::Crc32 rest;
    const std::uint64_t tick = detail::bits_of(tick_s_);
    for (const std::uint32_t word :
         {detail::scene_code<S>(), std::uint32_t{sizeof(Real)}, std::uint32_t{CRANKLOOP_VERSION},
          static_cast<std::uint32_t>(tick), static_cast<std::uint32_t>(tick >> 32)})
      rest.add(word);
    const std::uint64_t identity = supply_.identity();
    token_[0] = static_cast<std::uint32_t>(identity >> 32);
    token_[1] = static_cast<std::uint32_t>(identity);
    token_[2] = names.value();
    token_[3] = rest.value();
  }

  Supply supply_{};
  EngineShape shape_{};
  double tick_s_ = 0;
  Token token_{};
  std::uint32_t variables_ = 0;
  Slot slots_[kMaxVariables]{};

  Input<Real, S> input_{};  ///< kept_.inputs as the engine takes them
  Engine<Real, S> engine_{};
  Kept<Supply> kept_{};
};

}  // namespace crankloop::fmi
