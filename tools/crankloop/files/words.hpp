// Text helpers of the readers: splitting, quoting, and suggestions for misspelt words.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace crankloop::program {

/// Without blanks and tabs at both ends.
[[nodiscard]] std::string_view trim(std::string_view text) noexcept;

/// Trimmed parts between separators; "1,,2" has an empty one in the middle, "" is one empty part.
[[nodiscard]] std::vector<std::string_view> split(std::string_view text, char separator);

/// In single quotes, cut after 40 bytes, so that a long line does not flood a message.
[[nodiscard]] std::string in_quotes(std::string_view text);

/// Quoted for a shell: in single quotes if necessary.
[[nodiscard]] std::string shell_word(std::string_view text);

/// "a, b, c".
[[nodiscard]] std::string join(const std::vector<std::string>& words, const char* separator = ", ");

/// "1 row is too few for a cam", "3 rows are too few for a cam".
[[nodiscard]] std::string too_few_rows(std::size_t rows, const char* what);

/// The unit of a key in readable form: "kg mm^2" for "kg_mm2", "N/mm" for "N_per_mm".
[[nodiscard]] std::string unit_in_words(std::string_view unit);

/// "; did you mean bore_mm?" if one of the known words is close to the given one, otherwise "".
///
/// Close: equal but for case, or the end left out (bore for bore_mm), or at most a third of its letters, and 2
/// at most, inserted, removed, changed or swapped.
[[nodiscard]] std::string suggestion(std::string_view given, const std::vector<std::string>& known);

/// At most `count` of the known words, the nearest to the given one first: those that share most of its parts between
/// underscores, among them those with the fewest changed letters. None for a word of more than 64 bytes.
[[nodiscard]] std::vector<std::string> nearest(std::string_view given, const std::vector<std::string>& known,
                                               std::size_t count);

}  // namespace crankloop::program
