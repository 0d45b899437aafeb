// One study, map or stress test on many machines: each computes a shard and writes its part, one joins the parts.
//
// What belongs here: which points are whose, the file of a part, the options for it. What does not: what a point is and
// what its result says, which the command alone reads; who starts the machines' programs (docs/how_to.md).
//
// Every run takes the same way, whole ones too: results are lines of text by point, computed or read from parts, and
// the command makes its output of them. So the joined output is that of one machine by construction.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "../engine_file/engine_file.hpp"
#include "arguments.hpp"

namespace crankloop::program {

inline constexpr Option kThreads =
    whole_number("--threads", "N", from(1).up_to(1024),
                 "number of threads; default one for each processor that the process may use");
inline constexpr Option kShard =
    text("--shard", "K/N", "computes the Kth of N parts of the points only, for --part; K from 1");
inline constexpr Option kPart = text("--part", "F", "file for the part of --shard; - is standard output");
inline constexpr Option kJoin =
    words("--join", "F...", "reads the parts of all shards instead of computing; all other options as there");

/// FNV-1a over texts, for telling the parts of one study from those of another.
class Identity {
 public:
  Identity& add(std::string_view text);
  Identity& add_file(const EngineFile& file, const std::string& name);  ///< contents of a table that the file names
  Identity& add_engine(const EngineFile& file);                         ///< all that it says, and its tables
  [[nodiscard]] std::string text() const;                               ///< 16 hexadecimal digits

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325u;
};

/// What is divided.
struct Points {
  const char* command;   ///< "study"
  const char* progress;  ///< "studying"
  std::size_t count;
  Identity identity;  ///< of all that the results depend on
};

/// A number in the result of a point: as text, and back with all its bits; of nan and infinities the kind.
[[nodiscard]] std::string exact_text(double value);
[[nodiscard]] double exact_number(std::string_view text);

/// The result of a point: one line of text.
using PointWork = std::function<std::string(std::size_t point)>;

/// The results of all points, computed by all processors or joined; none where it has written the part of a shard, for
/// which `outputs`, options of the whole, are refused. Throws UsageError for options that do not fit, InputError for
/// parts that are not all shards of these points: missing, doubled, incomplete or of something else.
[[nodiscard]] std::optional<std::vector<std::string>> results_of(const Arguments& arguments, const Points& points,
                                                                 std::initializer_list<const char*> outputs,
                                                                 const PointWork& work);

}  // namespace crankloop::program
