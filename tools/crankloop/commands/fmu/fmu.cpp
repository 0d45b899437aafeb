// `crankloop fmu FILE -o engine.fmu`: an engine file as a functional mock-up unit, without a compiler.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include <crankloop/fmi/description.hpp>
#include <crankloop/scenes.hpp>

#include "../../command_line/commands.hpp"
#include "../../command_line/engine_argument.hpp"
#include "../../command_line/with_real.hpp"
#include "../../engine_file/following_springs.hpp"
#include "../../engine_file/gas_order.hpp"
#include "../../engine_file/plausibility.hpp"
#include "../../files/error.hpp"
#include "../../files/output_file.hpp"
#include "../../files/stored_zip.hpp"
#include "../../files/text_file.hpp"
#include "../../loops/valve_tick_limit.hpp"
#include "engine_source.hpp"
#include "license.hpp"  // made by the build

namespace crankloop::program {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxObjectBytes = std::size_t{256} << 20;

/// The folder of the files that FMUs contain, built or installed with the program: ../lib/crankloop.
fs::path prebuilt() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  return program.parent_path().parent_path() / "lib" / "crankloop";
}

[[noreturn]] void refuse_missing(const fs::path& path) {
  throw InputError("crankloop fmu: " + path.string() + " is not installed; build the target crankloop_fmus");
}

/// The binary of this platform, and that of Windows where it was built.
void add_binaries(std::vector<ZipEntry>& entries, const std::string& object, const std::string& identifier, bool two) {
  const std::string own = CRANKLOOP_FMU_PLATFORM;  // as FMI 3 has it
  const std::string own_folder = two && own == "x86_64-linux" ? "linux64" : own;
  const auto add = [&](const std::string& folder, const std::string& suffix, bool needed) {
    const fs::path path = prebuilt() / (object + suffix);
    std::error_code error;
    if (!fs::exists(path, error)) return needed ? refuse_missing(path) : void();
    FileBytes file = read_file(path.string(), kMaxObjectBytes);
    if (!file.ok()) throw InputError(path.string() + ": " + file.problem);
    entries.push_back({"binaries/" + folder + "/" + identifier + suffix, std::move(file.bytes)});
  };
  add(own_folder, ".so", true);
  add(two ? "win64" : "x86_64-windows", ".dll", false);
}

/// The sources of the binaries, and the command.
void add_sources(std::vector<ZipEntry>& entries, fmi::SourceBuild build, bool two) {
  const fs::path folder = prebuilt() / "fmu_sources";
  std::error_code error;
  if (!fs::exists(folder, error)) refuse_missing(folder);
  for (ZipEntry& file : files_below(folder.string())) {
    if (fs::path(file.name).extension() == ".cpp") build.files.push_back(file.name);
    entries.push_back({"sources/" + file.name, std::move(file.bytes)});
  }
  std::sort(build.files.begin(), build.files.end());
  entries.push_back({"sources/README.txt", build.read_me()});
  if (!two) entries.push_back({"sources/buildDescription.xml", build.description()});
}

/// The output's name as a C identifier: the name of the FMU and its binary.
std::string identifier_of(const std::string& path) {
  std::string name = fs::path(path).stem().string();
  for (char& c : name) {
    if (!((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'))) c = '_';
  }
  return name.empty() || (name[0] >= '0' && name[0] <= '9') ? "_" + name : name;
}

/// The engine file that is packed.
struct Packed {
  const EngineFile& engine;
  double tick_us;
};

/// The FMU's supply from resources in memory: no temporary files, however the program ends.
template <class Real, class Scene>
class PackedSupply : public FileSupply<Real, Scene> {
 public:
  static inline const Packed* packed = nullptr;  ///< static, because an instance constructs its supply and passes it
                                                 ///< only a path

  bool open(const char* /*resources*/, fmi::Message& why) noexcept {
    return this->open_source(why, [] { return std::make_unique<EngineSource>(packed->engine, packed->tick_us); });
  }
};

/// The FMU's description, computed by the code that it runs.
template <class Real, class Scene>
std::vector<ZipEntry> described(const Packed& packed, fmi::Version version, const fmi::Title& title) {
  using Supply = PackedSupply<Real, Scene>;
  Supply::packed = &packed;
  const auto instance = std::make_unique<fmi::Instance<Supply>>();
  fmi::Message why;
  if (!instance->open("", why)) {
    const double tick_s = millionths(packed.tick_us);
    const auto storage = std::make_unique<TableStorage<Real, Scene, kMaxGasSegments>>();
    const Status refused = storage->build(with_springs_that_follow(packed.engine.definition()), {tick_s});
    if (!refused.ok()) throw explain_tabulate(packed.engine, refused, tick_s);  // by the lines of the user's file
    throw InputError(why.text);
  }
  fmi::Description description(fmi::shown(*instance), title);
  return {{"modelDescription.xml", description.model(version)}, {"documentation/index.html", description.page()}};
}

int run_fmu(const Arguments& arguments) {
  const EngineFile engine = read_engine_for_scenes(arguments, {"engine", "crank", "masses"});
  const double tick_us = arguments.number("--tick-us");
  require_trains(engine, millionths(tick_us));
  const std::string& real = arguments.text("--real");
  const std::string& crank = arguments.text("--crank");
  const std::string& output = arguments.text("--output");
  const bool two = arguments.text("--fmi") == "2";
  const DrivenMachine& machine = engine.definition().machine;
  if (crank == "torque" && machine.constant_Nm == 0 && machine.linear_Nm_s == 0 && machine.quadratic_Nm_s2 == 0) {
    tell_warnings(arguments, {engine.path() + ": warning: there is no [machine] to load the engine, which speeds up "
                                              "at full load until external_torque_Nm is set"});
  }
  if (crank == "speed") tell_warnings(arguments, warnings_about_misfires_left_out(engine));
  std::vector<ZipEntry> resources = resources_of(engine, tick_us);
  Output out(output);
  const Packed packed{engine, tick_us};
  const fmi::Title title{identifier_of(output), engine.name(),
                         springs_surge(engine) ? "surge of the valve springs, which follow their valves" : ""};
  const auto version = two ? fmi::Version::two : fmi::Version::three;
  std::vector<ZipEntry> entries = with_real(real, [&](auto zero) {
    using Real = decltype(zero);
    if (breathes(engine.definition())) {
      return crank == "speed" ? described<Real, scenes::Breathing>(packed, version, title)
                              : described<Real, scenes::BreathingFree>(packed, version, title);
    }
    return crank == "speed" ? described<Real, scenes::Whole>(packed, version, title)
                            : described<Real, scenes::FreeRunning>(packed, version, title);
  });
  for (ZipEntry& entry : resources) entries.push_back({"resources/" + entry.name, entry.bytes});
  const std::string gas = breathes(engine.definition()) ? "gas_" : "";
  const std::string scene =
      gas.empty() ? (crank == "speed" ? "Whole" : "FreeRunning") : (crank == "speed" ? "Breathing" : "BreathingFree");
  add_binaries(entries, "fmu_" + gas + crank + "_" + real, title.identifier, two);
  add_sources(entries,
              {title.identifier,
               CRANKLOOP_FMU_FLAGS,
               {"include", "core"},
               {{"CRANKLOOP_FMU_SCENE", scene}, {"CRANKLOOP_FMU_REAL", real}},
               {}},
              two);
  entries.push_back({"documentation/licenses/license.txt", kLicense});
  sort_as_fmu(entries);

  out.write(stored_zip(entries));
  out.finish();
  return kSuccess;
}

constexpr Option kFmuOptions[] = {
    choice("--fmi", "2|3", "version of FMI", "3"),
    choice("--crank", "speed|torque", "input of the FMU: crank speed, or load torque", "speed"),
    number("--tick-us", "T", from(1).up_to(2000), "tick length in microseconds", "100"),
    choice("--real", "float|double", "arithmetic of the tick", "double"),
    required(text("--output", "FILE.fmu", "the FMU to write; -o for short")),
};

}  // namespace

const Command kFmu{"fmu",
                   "the engine for a simulator that imports FMI 2.0 or 3.0",
                   "FILE [--fmi 2|3] [--crank speed|torque] [--tick-us T] [--real R] -o FILE.fmu",
                   "crankloop fmu diesel_495.ini --crank torque -o diesel_495.fmu",
                   1,
                   kFmuOptions,
                   run_fmu};

}  // namespace crankloop::program
