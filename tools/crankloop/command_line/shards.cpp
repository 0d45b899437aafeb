#include "shards.hpp"

#include <cmath>
#include <limits>
#include <map>

#include <crankloop/version.h>

#include "../files/error.hpp"
#include "../files/number.hpp"
#include "../files/output_file.hpp"
#include "../files/text_file.hpp"
#include "../files/words.hpp"
#include "parallel.hpp"
#include "progress.hpp"

namespace crankloop::program {
namespace {

constexpr std::size_t kMaxPartBytes = std::size_t{1} << 30;
constexpr int kMaxShards = 100000;

/// Points are dealt like cards, so that every shard has its share of dear ones.
struct Shard {
  int number;
  int count;

  [[nodiscard]] std::size_t points(std::size_t of_all) const noexcept {
    const auto n = static_cast<std::size_t>(count);
    return of_all / n + (of_all % n >= static_cast<std::size_t>(number) ? 1 : 0);
  }
  [[nodiscard]] std::size_t point(std::size_t i) const noexcept {
    return i * static_cast<std::size_t>(count) + static_cast<std::size_t>(number - 1);
  }
  [[nodiscard]] std::string text() const { return "shard " + std::to_string(number) + " of " + std::to_string(count); }
};

Shard parse_shard(const std::string& text) {
  const auto parts = split(text, '/');
  int numbers[2] = {};
  for (std::size_t i = 0; i < 2; ++i) {
    const ParsedNumber number = parse_number(parts.size() == 2 ? parts[i] : "", from(1).up_to(kMaxShards), "");
    numbers[i] = static_cast<int>(number.value);
    if (!number.ok() || numbers[i] != number.value)
      throw UsageError("--shard: " + in_quotes(text) + " is no K/N, like 3/8; both are whole numbers from 1 to " +
                       std::to_string(kMaxShards));
  }
  if (numbers[0] > numbers[1]) throw UsageError("--shard: " + in_quotes(text) + ": K must be at most N");
  return {numbers[0], numbers[1]};
}

/// The first line of a part: equal for parts that belong together.
std::string what_of(const Points& points) {
  Identity identity = points.identity;
  identity.add(std::to_string(CRANKLOOP_VERSION));
  return "crankloop part of " + std::string(points.command) + ", " + std::to_string(points.count) + " points, " +
         identity.text();
}

constexpr const char* kEnd = "end";

/// A part that was read. Lines: what, shard, a result for each of its points, "end".
struct Part {
  std::string path;
  Shard shard;
  std::vector<std::string> results;
};

Part read_part(const std::string& path, const Points& points) {
  const FileBytes file = read_file(path, kMaxPartBytes);
  if (!file.ok()) throw InputError(path + ": " + file.problem);
  std::vector<std::string> lines = split_lines(file.bytes, path);
  const std::string what = what_of(points);
  const std::string start = "crankloop part of " + std::string(points.command) + ", ";
  if (lines.empty() || lines[0].rfind(start, 0) != 0)
    throw InputError(path + ": is no part of a `crankloop " + points.command + " --shard K/N`");
  if (lines[0] != what)
    throw InputError(path + ": is a part of another " + points.command +
                     ": the engine file, a table that it names, an option or the program's version differs");
  const std::string incomplete = path + ": is not complete; run its shard again";
  if (lines.size() < 3 || lines.back() != kEnd) throw InputError(incomplete);
  const auto words = split(lines[1], ' ');
  if (words.size() != 4 || words[0] != "shard") throw InputError(incomplete);
  Part part{path, parse_shard(std::string(words[1]) + "/" + std::string(words[3])), {}};
  part.results.assign(std::make_move_iterator(lines.begin() + 2), std::make_move_iterator(lines.end() - 1));
  if (part.results.size() != part.shard.points(points.count)) throw InputError(incomplete);
  return part;
}

/// Notes which part has a shard; refuses a second one.
void note(std::map<int, std::string>& paths, const Part& part, int count, const std::string& first_path) {
  if (part.shard.count != count)
    throw InputError(part.path + ": is " + part.shard.text() + ", but " + first_path + " is one of " +
                     std::to_string(count));
  const auto [found, is_new] = paths.emplace(part.shard.number, part.path);
  if (!is_new)
    throw InputError(part.path + ": is " + part.shard.text() + ", as is " + found->second + "; each is needed once");
}

void require_all(const std::map<int, std::string>& paths, int count) {
  std::vector<std::string> missing;
  for (int number = 1; number <= count; ++number) {
    if (paths.count(number) == 0) missing.push_back(std::to_string(number));
  }
  if (missing.empty()) return;
  const bool one = missing.size() == 1;
  constexpr std::size_t kShown = 20;
  const std::size_t more = missing.size() > kShown ? missing.size() - kShown : 0;
  missing.resize(missing.size() - more);
  throw InputError("--join: shard" + std::string(one ? " " : "s ") + join(missing) +
                   (more > 0 ? " and " + std::to_string(more) + " more" : "") + " of " + std::to_string(count) +
                   (one ? " is missing" : " are missing"));
}

std::vector<std::string> joined(const std::vector<std::string>& paths_of_parts, const Points& points) {
  std::vector<std::string> results(points.count);
  std::map<int, std::string> paths;
  int count = 0;
  for (const std::string& path : paths_of_parts) {
    Part part = read_part(path, points);
    if (count == 0) count = part.shard.count;
    note(paths, part, count, paths_of_parts[0]);
    for (std::size_t i = 0; i < part.results.size(); ++i) results[part.shard.point(i)] = std::move(part.results[i]);
  }
  require_all(paths, count);
  return results;
}

std::vector<std::string> computed(const Arguments& arguments, const Points& points, const Shard& shard,
                                  const PointWork& work) {
  std::vector<std::string> results(shard.points(points.count));
  Progress progress(points.progress, static_cast<double>(results.size()), Progress::kLogPeriod_ns);
  const int threads = arguments.has(kThreads.name) ? arguments.whole_number(kThreads.name) : processors();
  run_in_parallel(
      threads, results.size(), [&](std::size_t i) { results[i] = work(shard.point(i)); },
      [&progress] { progress.long_step(); });
  return results;
}

void require_options_that_fit(const Arguments& arguments, std::initializer_list<const char*> outputs) {
  const bool shard = arguments.has(kShard.name);
  if (shard != arguments.has(kPart.name)) throw UsageError("--shard and --part belong together; give both");
  arguments.refuse_with(kShard.name, {kJoin.name});
  for (const char* output : outputs) {
    if (shard && arguments.has(output))
      throw UsageError(std::string(output) + " is of all points; give it with --join, when all shards have run");
  }
}

}  // namespace

Identity& Identity::add(std::string_view text) {
  const auto take = [this](unsigned char byte) { hash_ = (hash_ ^ byte) * 0x100000001b3u; };
  for (const char byte : text) take(static_cast<unsigned char>(byte));
  take(0);  // "ab", "c" is not "a", "bc"
  return *this;
}

Identity& Identity::add_file(const EngineFile& file, const std::string& name) {
  return add(read_file(in_folder(folder_of(file.path()), name), kMaxPartBytes).bytes);
}

Identity& Identity::add_engine(const EngineFile& file) {
  add(show(file));
  for (const SectionValues& section : file.sections()) {
    for (const Value& value : section.values) {
      if (value.used && value.key->kind == Kind::path) add_file(file, value.text);
    }
  }
  return *this;
}

std::string Identity::text() const {
  std::string digits;
  for (int shift = 60; shift >= 0; shift -= 4) digits += "0123456789abcdef"[hash_ >> shift & 15];
  return digits;
}

std::string exact_text(double value) {
  if (std::isnan(value)) return "nan";
  return std::isinf(value) ? (value > 0 ? "inf" : "-inf") : shortest(value);
}

double exact_number(std::string_view text) {
  if (const ParsedNumber number = parse_number(text); number.ok()) return number.value;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return text == "inf" ? kInfinity : text == "-inf" ? -kInfinity : std::numeric_limits<double>::quiet_NaN();
}

std::optional<std::vector<std::string>> results_of(const Arguments& arguments, const Points& points,
                                                   std::initializer_list<const char*> outputs, const PointWork& work) {
  require_options_that_fit(arguments, outputs);
  if (arguments.has(kJoin.name)) return joined(arguments.words(kJoin.name), points);
  if (!arguments.has(kShard.name)) return computed(arguments, points, {1, 1}, work);
  const Shard shard = parse_shard(arguments.text(kShard.name));
  Output out(arguments.text(kPart.name));
  out.write(what_of(points) + "\n" + shard.text() + "\n");
  for (const std::string& result : computed(arguments, points, shard, work)) out.write(result + "\n");
  out.write(std::string(kEnd) + "\n");
  out.finish();
  return {};
}

}  // namespace crankloop::program
