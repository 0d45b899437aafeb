// `crankloop show FILE`: the complete definition as an engine file.
#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <crankloop/tabulate/spring_margin.hpp>
#include <crankloop/tabulate/valve_motion.hpp>

#include "../command_line/commands.hpp"
#include "../command_line/engine_argument.hpp"
#include "../engine_file/crankshaft_words.hpp"
#include "../files/error.hpp"
#include "../files/output_file.hpp"
#include "../files/units.hpp"
#include "../files/words.hpp"
#include "../loops/valve_tick_limit.hpp"

namespace crankloop::program {
namespace {

constexpr std::size_t kCommentColumn = 40;

/// Relative paths are made absolute, so that the output can be read from any folder; unless an engine file cannot hold
/// the folder's name.
std::string path_for_everywhere(const std::string& written, const std::string& engine_path) {
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::path(engine_path).parent_path();
  const std::filesystem::path whole = std::filesystem::absolute(folder / written, error).lexically_normal();
  const std::string text = whole.string();
  const bool survives = text.find(" #") == std::string::npos && text.find("\t#") == std::string::npos &&
                        text.find('\n') == std::string::npos && trim(text) == text;
  return error || !survives ? written : text;
}

std::string show_section(const SectionValues& section, const std::string& engine_path) {
  std::string text = "\n" + section.title() + "\n";
  for (const Value& value : section.values) {
    std::string line = std::string(value.key->name) + " = ";
    line += value.key->kind == Kind::path ? path_for_everywhere(value.text, engine_path) : format_value(value);
    line.resize(std::max(kCommentColumn, line.size() + 2), ' ');
    line += std::string("# ") + value.key->meaning;
    if (value.automatic) line += "; chosen by auto";
    if (!value.used) line += std::string("; not used: only with ") + value.key->only_if;
    text += line + "\n";
  }
  return text;
}

/// By spring and mass alone: where each train's valve would float if nothing gave way.
std::vector<std::string> redlines_in_words(const EngineFile& file) {
  std::vector<std::string> lines;
  for (const TrainOfFile& train : file.trains()) {
    const auto lift = std::make_unique<ValveLift>();
    if (!train.complete() || !lift->init(train.definition.cam, train.definition.rocker).ok()) continue;
    const StaticRedline redline = static_redline(*lift, valve_body(train.definition.valve, *lift));
    std::string line = "static redline of train " + train.name + ": ";
    if (redline.crank_rad_s > 0) {
      line += brief(redline.crank_rad_s * kRpmPerRad_s) + " rpm, at " + brief(redline.cam_deg) +
              " cam deg from full lift; rigid parts without damping";
    } else {
      line += "none, its valve never opens";
    }
    lines.push_back(line);
  }
  return lines;
}

int run_show(const Arguments& arguments) {
  const EngineFile engine = read_engine(arguments, {});
  Output out = Output::standard();
  out.write(show(engine));
  out.finish();
  return kSuccess;
}

}  // namespace

std::string show(const EngineFile& engine) {
  std::string text = "# A complete engine definition: every default is filled in.\n";
  for (const SectionValues& section : engine.sections()) {
    text += show_section(section, engine.path());
    if (section.kind == "layout") text += crankshaft_comments(engine.definition().layout);
  }
  if (engine.has("crank") && !engine.has("masses")) {
    text += "\n# There is no [masses] section, and it has no defaults: no forces.\n";
  }
  for (const std::string& line : ticks_in_words(engine)) text += "\n# " + line + "\n";
  for (const std::string& line : redlines_in_words(engine)) text += "\n# " + line + "\n";
  return text;
}

const Command kShow{"show",  "prints an engine file complete, with every default filled in",
                    "FILE",  "crankloop show diesel_495.ini > complete.ini",
                    1,       {},
                    run_show};

}  // namespace crankloop::program
