#include "words.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace crankloop::program {
namespace {

constexpr std::size_t kLongestQuote = 40;
constexpr std::size_t kLongestGuess = 64;  // bounds the quadratic work of edit_distance() on hostile files

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return result;
}

/// Insertions, removals, changes and swaps of neighbours that turn one word into the other (optimal string alignment).
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> steps(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        steps[i][j] = i + j;
        continue;
      }
      const std::size_t change = a[i - 1] == b[j - 1] ? 0 : 1;
      steps[i][j] = std::min({steps[i - 1][j] + 1, steps[i][j - 1] + 1, steps[i - 1][j - 1] + change});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        steps[i][j] = std::min(steps[i][j], steps[i - 2][j - 2] + 1);
      }
    }
  }
  return steps[a.size()][b.size()];
}

/// "bore" of "bore_mm": users often forget the unit.
bool is_leading_part(std::string_view given, std::string_view known) {
  return given.size() >= 3 && known.size() > given.size() && known.compare(0, given.size(), given) == 0;
}

}  // namespace

std::string_view trim(std::string_view text) noexcept {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (std::size_t start = 0;;) {
    const auto end = text.find(separator, start);
    parts.push_back(trim(text.substr(start, end - start)));
    if (end == std::string_view::npos) return parts;
    start = end + 1;
  }
}

std::string in_quotes(std::string_view text) {
  if (text.size() <= kLongestQuote) return "'" + std::string(text) + "'";
  std::size_t end = kLongestQuote;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0u) == 0x80u) --end;  // not inside a UTF-8 character
  return "'" + std::string(text.substr(0, end)) + "...'";
}

std::string shell_word(std::string_view text) {
  constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./:,+-=@%";
  if (!text.empty() && text.find_first_not_of(kPlain) == std::string_view::npos) return std::string(text);
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

std::string join(const std::vector<std::string>& words, const char* separator) {
  std::string text;
  for (const std::string& word : words) {
    if (!text.empty()) text += separator;
    text += word;
  }
  return text;
}

std::string too_few_rows(std::size_t rows, const char* what) {
  return std::to_string(rows) + (rows == 1 ? " row is" : " rows are") + " too few for " + what;
}

std::string unit_in_words(std::string_view unit) {
  std::string text(unit);
  if (const std::size_t per = text.find("_per_"); per != std::string::npos) text.replace(per, 5, "/");
  std::replace(text.begin(), text.end(), '_', ' ');
  if (!text.empty() && text.back() == '2') text.insert(text.size() - 1, "^");
  return text;
}

namespace {
/// Names of version 0.1 that have changed.
constexpr std::pair<std::string_view, std::string_view> kRenamed[] = {
    {"load", "machine"}, {"--load-Nm", "--machine-Nm"}, {"--load-Nm", "--external-torque-Nm"}};
}  // namespace

std::string suggestion(std::string_view given, const std::vector<std::string>& known) {
  if (given.empty() || given.size() > kLongestGuess) return "";
  for (const auto& [before, now] : kRenamed) {
    if (given == before && std::find(known.begin(), known.end(), now) != known.end())
      return "; it is now called " + std::string(now);
  }
  const std::string word = lower(given);
  const std::string* best = nullptr;
  std::size_t best_distance = std::min<std::size_t>(2, given.size() / 3) + 1;
  for (const std::string& candidate : known) {
    const std::string other = lower(candidate);
    const std::size_t distance = is_leading_part(word, other) ? 1 : edit_distance(word, other);
    if (distance < best_distance) {
      best = &candidate;
      best_distance = distance;
    }
  }
  return best == nullptr ? "" : "; did you mean " + *best + "?";
}

std::vector<std::string> nearest(std::string_view given, const std::vector<std::string>& known, std::size_t count) {
  if (given.size() > kLongestGuess) return {};
  const std::string word = lower(given);
  const std::vector<std::string_view> parts = split(word, '_');
  struct Near {
    std::ptrdiff_t parts_shared;
    std::size_t distance;
    const std::string* word;
  };
  std::vector<Near> all;
  for (const std::string& one : known) {
    const std::string other = lower(one);
    const std::vector<std::string_view> of_other = split(other, '_');
    const auto shared = std::count_if(parts.begin(), parts.end(), [&](std::string_view part) {
      return !part.empty() && std::find(of_other.begin(), of_other.end(), part) != of_other.end();
    });
    all.push_back({shared, edit_distance(word, other), &one});
  }
  std::stable_sort(all.begin(), all.end(), [](const Near& a, const Near& b) {
    return a.parts_shared != b.parts_shared ? a.parts_shared > b.parts_shared : a.distance < b.distance;
  });
  std::vector<std::string> words;
  for (std::size_t i = 0; i < std::min(count, all.size()); ++i) words.push_back(*all[i].word);
  return words;
}

}  // namespace crankloop::program
