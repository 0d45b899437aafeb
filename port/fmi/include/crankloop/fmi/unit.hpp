// What the functions of both FMI versions do: an instance as its importer holds it, checked calls, messages, memory.
//
// What belongs here: which call is allowed when, and what a refused one answers. What does not: the model
// (fmi/instance.hpp), the functions' names and types (fmi/fmi2_exports.inc, fmi/fmi3_exports.inc).
//
// A refused call logs the reason by the importer's logger, returns error, and changes nothing.
#pragma once

#include <cstdlib>
#include <new>

#include <crankloop/fmi/instance.hpp>

namespace crankloop::fmi {

/// Answers of a call: in both versions the same numbers.
enum Answer : int { kOk = 0, kDiscard = 2, kError = 3 };

inline constexpr const char* kErrorCategory = "logStatusError";
inline constexpr const char* kFaultCategory = "logFaults";
inline constexpr const char* kNullPointer = "a null pointer";
inline constexpr const char* kOtherType =
    "this FMU is for co-simulation only, without event mode and intermediate updates";

/// The importer's logger, which may be null. Errors are always told, faults where logging is on.
struct Logger {
  void (*send)(const Logger&, Answer, const char* category, const char* message) = nullptr;
  void (*function)() = nullptr;  ///< of the version's type
  void* environment = nullptr;
  const char* instance_name = "";
  bool tells_faults = false;

  void say(Answer answer, const char* category, const char* message) const noexcept {
    if (function != nullptr) send(*this, answer, category, message);
  }
};

/// Stages as bits, for the calls that are allowed in several.
[[nodiscard]] constexpr std::uint32_t in(Stage stage) noexcept { return 1u << static_cast<std::uint32_t>(stage); }
inline constexpr std::uint32_t kGetStages = in(Stage::initializing) | in(Stage::stepping) | in(Stage::terminated);
inline constexpr std::uint32_t kSetStages = in(Stage::instantiated) | in(Stage::initializing) | in(Stage::stepping);

template <class Supply>
class Unit {
 public:
  static constexpr std::size_t kStateBytes = Instance<Supply>::kStateBytes;

  /// Null where memory, resources or token refuse. `resources` may be null where the supply needs none.
  static Unit* create(std::uint32_t version, const char* name, const char* token, const char* resources,
                      Logger logger) noexcept {
    if (name == nullptr || name[0] == '\0') return refuse_instance(logger, "an instance needs a name");
    const std::size_t name_bytes = std::strlen(name) + 1;
    void* memory = std::malloc(sizeof(Unit) + name_bytes);
    if (memory == nullptr) return refuse_instance(logger, "there is no memory for an instance");
    Unit* unit = new (memory) Unit(version);
    char* kept_name = static_cast<char*>(memory) + sizeof(Unit);
    std::memcpy(kept_name, name, name_bytes);
    unit->logger = logger;
    unit->logger.instance_name = kept_name;
    Message why;
    const bool opened = unit->instance.open(resources, why);
    const TokenText right(unit->instance.token());
    if (opened && token != nullptr && std::strcmp(token, right.text) == 0) return unit;
    if (opened) why.say("the token is not this FMU's: model description and binary are of different builds");
    logger.instance_name = name;
    (void)refuse_instance(logger, why.text);
    destroy(unit, version);
    return nullptr;
  }
  /// Refused, with nothing made.
  static Unit* refuse_instance(const Logger& logger, const char* why) noexcept {
    logger.say(kError, kErrorCategory, why);
    return nullptr;
  }
  static void destroy(void* handle, std::uint32_t version) noexcept {
    Unit* unit = of(handle, version);
    if (unit == nullptr) return;
    unit->version_ = 0;
    unit->~Unit();
    std::free(unit);
  }

  /// Runs the call of an FMI function with the instance that an importer gave; where that is none of this version there
  /// is nobody to tell.
  template <class Call>
  static Answer with(void* handle, std::uint32_t version, const char* function, const Call& call) noexcept {
    Unit* unit = of(handle, version);
    if (unit == nullptr) return kError;
    unit->function_ = function;
    return call(*unit);
  }

  /// A refusal is reported with the function's name.
  [[gnu::noinline]] Answer refuse(const char* why) const noexcept {
    Message message;
    message.say("%s: %s", function_, why);
    logger.say(kError, kErrorCategory, message.text);
    return kError;
  }
  /// Of what this FMU has not.
  Answer refuse_always() const noexcept { return refuse("this FMU has no such capability"); }

  Answer set_logging(bool on, std::size_t count, const char* const* categories) noexcept {
    if (count > 0 && categories == nullptr) return refuse(kNullPointer);
    bool faults = count == 0;
    for (std::size_t i = 0; i < count; ++i) {
      const char* category = categories[i];
      const bool fault = category != nullptr && std::strcmp(category, kFaultCategory) == 0;
      const bool error = category != nullptr && std::strcmp(category, kErrorCategory) == 0;
      if (!fault && !error) return refuse("there is no such category");
      faults = faults || fault;
    }
    if (faults) logger.tells_faults = on;
    return kOk;
  }

  // ---- variables: all of a call's references are good, or none is read or set -----------------------------------

  template <class Value>
  Answer get(VariableKind kind, const std::uint32_t* references, std::size_t count, Value* values,
             std::size_t value_count) const noexcept {
    if (!allows(kGetStages) || !counts_agree(references, count, values, value_count)) return kError;
    for (std::size_t i = 0; i < count; ++i) {
      if (!instance.has(references[i], kind)) return refuse_reference(references[i]);
    }
    for (std::size_t i = 0; i < count; ++i) values[i] = shown<Value>(kind, instance.number(references[i]));
    return kOk;
  }
  template <class Value>
  Answer set(VariableKind kind, const std::uint32_t* references, std::size_t count, const Value* values,
             std::size_t value_count) noexcept {
    if (!allows(kSetStages) || !counts_agree(references, count, values, value_count)) return kError;
    for (std::size_t i = 0; i < count; ++i) {
      if (!instance.takes(references[i], kind)) return refuse_reference(references[i]);
      if (kind == VariableKind::whole && static_cast<double>(values[i]) < 0) return refuse("a negative whole number");
    }
    for (std::size_t i = 0; i < count; ++i) {
      const auto value = static_cast<double>(values[i]);
      instance.set_number(references[i], kind != VariableKind::truth ? value : value != 0 ? 1.0 : 0.0);
    }
    return kOk;
  }
  /// Of a type that no variable has: only an empty list can be read or set.
  Answer none_of_type(std::size_t count) const noexcept {
    return count == 0 ? kOk : refuse("no variable has this type");
  }

  // ---- life cycle ---------------------------------------------------------------------------------------------------

  Answer set_start(double start_s) noexcept {
    Message why;
    return allows(in(Stage::instantiated)) ? answer(instance.set_start(start_s, why), why) : kError;
  }
  Answer begin_initialization() noexcept {
    return allows(in(Stage::instantiated)) ? (instance.begin_initialization(), kOk) : kError;
  }
  /// As FMI 3 has both in one call.
  Answer begin_initialization(double start_s) noexcept {
    const Answer started = set_start(start_s);
    return started == kOk ? begin_initialization() : started;
  }
  Answer finish_initialization() noexcept {
    Message why;
    return allows(in(Stage::initializing)) ? answer(instance.finish_initialization(why), why) : kError;
  }
  Answer terminate() noexcept { return allows(in(Stage::stepping)) ? (instance.terminate(), kOk) : kError; }
  Answer reset() noexcept { return instance.reset(), kOk; }
  [[gnu::always_inline]] Answer step(double time_s, double step_s) noexcept {
    if (instance.stage() != Stage::stepping) return refuse_now();
    const std::uint32_t faults_before = instance.faults();
    if (!instance.step(time_s, step_s)) return refuse_step(time_s, step_s);
    if (instance.faults() != 0 && instance.faults() != faults_before && logger.tells_faults) tell_faults();
    return kOk;
  }
  /// As FMI 3 has it: what a step may ask for, which no step does, and where it ended.
  [[gnu::always_inline]] Answer step(double time_s, double step_s, bool* needs_event, bool* ends_simulation,
                                     bool* returns_early, double* last_time_s) noexcept {
    if (needs_event == nullptr || ends_simulation == nullptr || returns_early == nullptr || last_time_s == nullptr)
      return refuse(kNullPointer);
    *needs_event = *ends_simulation = *returns_early = false;
    const Answer stepped = step(time_s, step_s);
    *last_time_s = instance.time_s();
    return stepped;
  }
  /// As FMI 2 asks of the last step: the one number and the one truth that there are.
  Answer last_time(bool asked, double* time_s) const noexcept {
    if (time_s == nullptr) return refuse(kNullPointer);
    if (!asked || !allows(kGetStages)) return kDiscard;
    *time_s = instance.time_s();
    return kOk;
  }
  Answer never(bool asked, int* truth) const noexcept {
    if (truth == nullptr) return refuse(kNullPointer);
    if (asked) *truth = 0;
    return asked ? kOk : kDiscard;
  }
  Answer discard() const noexcept { return kDiscard; }

  // ---- stored states: the bytes of instance.save(), in memory of their own ------------------------------------------

  Answer get_state(void** state) const noexcept {
    const Answer made = make_room(state);
    if (made == kOk) instance.save(static_cast<unsigned char*>(*state));
    return made;
  }
  Answer set_state(const void* state) noexcept {
    if (state == nullptr) return refuse(kNullPointer);
    Message why;
    return answer(instance.load(static_cast<const unsigned char*>(state), why), why);
  }
  Answer free_state(void** state) const noexcept {
    if (state == nullptr) return refuse(kNullPointer);
    std::free(*state);
    *state = nullptr;
    return kOk;
  }
  Answer state_size(const void* state, std::size_t* size) const noexcept {
    if (state == nullptr || size == nullptr) return refuse(kNullPointer);
    *size = kStateBytes;
    return kOk;
  }
  Answer write_state(const void* state, void* bytes, std::size_t size) const noexcept {
    if (state == nullptr || bytes == nullptr) return refuse(kNullPointer);
    if (size < kStateBytes) return refuse("too little room for a state");
    std::memcpy(bytes, state, kStateBytes);
    return kOk;
  }
  Answer read_state(const void* bytes, std::size_t size, void** state) const noexcept {
    if (bytes == nullptr) return refuse(kNullPointer);
    if (size != kStateBytes) return refuse("not the size of a state");
    Message why;
    if (!instance.check(static_cast<const unsigned char*>(bytes), why)) return refuse(why.text);
    const Answer made = make_room(state);
    if (made == kOk) std::memcpy(*state, bytes, kStateBytes);
    return made;
  }

  Logger logger{};
  Instance<Supply> instance{};

 private:
  explicit Unit(std::uint32_t version) noexcept : version_{version} {}
  ~Unit() = default;

  static Unit* of(void* handle, std::uint32_t version) noexcept {
    auto* unit = static_cast<Unit*>(handle);
    return unit != nullptr && unit->version_ == version ? unit : nullptr;
  }

  /// Memory of a state, where the importer hands none back to be filled again.
  Answer make_room(void** state) const noexcept {
    if (state == nullptr) return refuse(kNullPointer);
    if (*state == nullptr) *state = std::malloc(kStateBytes);
    return *state != nullptr ? kOk : refuse("there is no memory for a state");
  }

  /// Whether the function may be called at this stage; reports if not.
  [[nodiscard]] bool allows(std::uint32_t stages) const noexcept {
    return (stages & in(instance.stage())) != 0 || (refuse_now(), false);
  }
  Answer refuse_now() const noexcept {
    static constexpr const char* kNotNow[] = {"not allowed while instantiated", "not allowed in initialization mode",
                                              "not allowed in step mode", "not allowed when terminated"};
    return refuse(kNotNow[static_cast<std::uint32_t>(instance.stage())]);
  }
  [[gnu::noinline]] Answer refuse_step(double time_s, double step_s) const noexcept {
    Message why;
    instance.say_why_no_step(time_s, step_s, why);
    return refuse(why.text);
  }
  [[gnu::noinline]] void tell_faults() const noexcept {
    Message what;
    what.say("fault bits 0x%x in the step to %.9g s", instance.faults(), instance.time_s());
    logger.say(kOk, kFaultCategory, what.text);
  }
  Answer answer(bool good, const Message& why) const noexcept { return good ? kOk : refuse(why.text); }

  [[nodiscard]] bool counts_agree(const std::uint32_t* references, std::size_t count, const void* values,
                                  std::size_t value_count) const noexcept {
    if (count != value_count) return refuse("as many values as value references are needed"), false;
    const bool there = count == 0 || (references != nullptr && values != nullptr);
    return there || (refuse(kNullPointer), false);
  }
  Answer refuse_reference(std::uint32_t reference) const noexcept {
    Message why;
    why.say("value reference %u is none that it could be called with now", reference);
    return refuse(why.text);
  }
  /// As the importer's type has it: of a mask or count beyond what a signed number holds, the rest.
  template <class Value>
  [[nodiscard]] static Value shown(VariableKind kind, double number) noexcept {
    if (kind == VariableKind::real) return static_cast<Value>(number);
    if (kind == VariableKind::truth) return static_cast<Value>(number != 0);
    const auto whole = static_cast<std::uint32_t>(number);
    return static_cast<Value>(std::is_signed_v<Value> ? whole & kMaxWhole : whole);
  }

  std::uint32_t version_;
  const char* function_ = "";  ///< the call that is being answered
};

/// The path of a resource URI, "file:///a%20b" or "file:/a%20b", into `path`; false for another scheme, another
/// machine's file, a path with a zero in it, and one too long.
[[nodiscard]] inline bool path_of_uri(const char* uri, char* path, std::size_t room) noexcept {
  constexpr char kScheme[] = "file:";
  if (uri == nullptr || std::strncmp(uri, kScheme, 5) != 0) return false;
  uri += 5;
  if (uri[0] == '/' && uri[1] == '/') {  // an authority: none, or localhost
    uri += std::strncmp(uri + 2, "localhost/", 10) == 0 ? 11 : 2;
    if (uri[0] != '/') return false;
  }
#if defined(_WIN32)
  if (uri[0] == '/' && uri[1] != '\0' && uri[2] == ':') ++uri;  // "/C:/..."
#endif
  const auto digit = [](char c) {
    static constexpr char kDigits[] = "0123456789abcdef0123456789ABCDEF";
    const char* at = c != '\0' ? std::strchr(kDigits, c) : nullptr;
    return at != nullptr ? static_cast<int>(at - kDigits) % 16 : -1;
  };
  for (; *uri != '\0'; ++uri, ++path, --room) {
    if (room < 2) return false;
    *path = *uri;
    if (*uri == '%' && digit(uri[1]) >= 0 && digit(uri[2]) >= 0) {
      *path = static_cast<char>(digit(uri[1]) * 16 + digit(uri[2]));
      if (*path == '\0') return false;
      uri += 2;
    }
  }
  *path = '\0';
  return room > 0;
}

}  // namespace crankloop::fmi
