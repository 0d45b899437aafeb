#include "costs.hpp"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <map>
#include <set>
#include <sstream>

#include "thumb.hpp"

namespace worst_tick {
namespace {

enum class Kind {
  plain,
  flags,  ///< may end in s
  load,
  store,
  arithmetic,  ///< its floating-point result is late for the next instruction
  compare,     ///< likewise its flags, for VMRS
  transfer     ///< between registers: twice as long if one is of the core
};

struct Row {
  const char* mnemonics;
  int cycles;
  int per_word;  ///< besides, of a list or a pair; in the manual: N
  Kind kind;
};

// Arm DDI 0439, tables 3-1 (the core) and 7-1 (the floating-point unit); P is kCortexM4Refill, added where a branch is
// taken.
constexpr Row kTable[] = {
    {"mov mvn add sub adc sbc rsb neg and orr orn eor bic lsl lsr asr ror rrx", 1, 0, Kind::flags},
    {"movw movt addw subw adr cmp cmn tst teq", 1, 0, Kind::plain},
    {"bfi bfc ubfx sbfx clz rbit rev rev16 revsh uxtb uxth sxtb sxth ssat usat", 1, 0, Kind::plain},
    {"mul", 1, 0, Kind::flags},
    {"smull umull", 1, 0, Kind::plain},
    {"mla mls smlal umlal", 2, 0, Kind::plain},  // 1 in some revisions of the manual
    {"sdiv udiv", 12, 0, Kind::plain},           // 2 to 12, by the operands
    {"b bl bx cbz cbnz nop", 1, 0, Kind::plain},
    {"it itt ite ittt itte itet itee itttt ittte ittet ittee itett itete iteet iteee", 1, 0, Kind::plain},
    {"ldr ldrb ldrh ldrsb ldrsh", 2, 0, Kind::load},
    {"ldrd ldm ldmia ldmdb pop", 1, 1, Kind::load},
    {"str strb strh", 2, 0, Kind::store},
    {"strd stm stmia stmdb push", 1, 1, Kind::store},
    {"vadd vsub vmul vnmul vabs vneg vcvt vcvtr", 1, 0, Kind::arithmetic},
    {"vmla vmls vnmla vnmls vfma vfms vfnma vfnms", 3, 0, Kind::arithmetic},
    {"vdiv vsqrt", 14, 0, Kind::arithmetic},
    {"vcmp vcmpe", 1, 0, Kind::compare},
    {"vmrs vmsr", 1, 0, Kind::plain},
    {"vmov", 1, 0, Kind::transfer},
    {"vldr vldm vldmia vldmdb vpop", 1, 1, Kind::load},
    {"vstr vstm vstmia vstmdb vpush", 1, 1, Kind::store},
};

[[nodiscard]] const std::map<std::string, const Row*>& rows() {
  static const std::map<std::string, const Row*> all = [] {
    std::map<std::string, const Row*> made;
    for (const Row& row : kTable) {
      std::istringstream names(row.mnemonics);
      for (std::string name; names >> name;) {
        made[name] = &row;
        if (row.kind == Kind::flags) made[name + "s"] = &row;
      }
    }
    return made;
  }();
  return all;
}

/// "vmovmi.f32" -> the row of vmov.
[[nodiscard]] const Row& row_of(const Instruction& i) {
  std::string name = i.mnemonic.substr(0, i.mnemonic.find('.'));
  auto found = rows().find(name);
  if (found == rows().end() && name.size() > 2 && is_condition(name.substr(name.size() - 2)))
    found = rows().find(name.substr(0, name.size() - 2));
  if (found == rows().end())
    throw Refusal(hex(i.address) + ": no cycles are known of " + i.mnemonic + " " + i.operands);
  return *found->second;
}

/// "s4", "d2", "r10", "fp"; up to what is neither letter nor digit.
[[nodiscard]] std::string word_at(const std::string& text, std::size_t at) {
  std::size_t end = at;
  while (end < text.size() && std::isalnum(static_cast<unsigned char>(text[end])) != 0) ++end;
  return text.substr(at, end - at);
}

[[nodiscard]] std::vector<std::string> words_in(const std::string& text) {
  std::vector<std::string> all;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const std::string word = word_at(text, at);
    if (word.empty()) continue;
    all.push_back(at > 0 && text[at - 1] == '-' ? "-" + word : word);
    at += word.size() - 1;
  }
  return all;
}

/// Whether "s4", "d2", and of which words of the floating-point registers.
[[nodiscard]] bool float_register(const std::string& word, int& first, int& last) {
  if (word.size() < 2 || (word[0] != 's' && word[0] != 'd')) return false;
  if (!std::all_of(word.begin() + 1, word.end(), [](unsigned char c) { return std::isdigit(c) != 0; })) return false;
  const int number = std::atoi(word.c_str() + 1);
  first = word[0] == 'd' ? 2 * number : number;
  last = word[0] == 'd' ? first + 1 : first;
  return true;
}

/// The floating-point registers that a text names, by words; "s4-s7" names four.
[[nodiscard]] std::set<int> float_words(const std::string& text) {
  std::set<int> all;
  int begin = 0;
  for (const std::string& word : words_in(text)) {
    int first = 0, last = 0;
    const bool range = word[0] == '-';
    if (!float_register(range ? word.substr(1) : word, first, last)) continue;
    for (int w = range ? begin : first; w <= last; ++w) all.insert(w);
    begin = first;
  }
  return all;
}

/// Words that an instruction moves from or to memory.
[[nodiscard]] int words_moved(const Instruction& i, const Row& row) {
  const std::size_t open = i.operands.find('{');
  if (i.mnemonic[0] == 'v') return static_cast<int>(float_words(i.operands).size());
  if (open != std::string::npos) {
    const std::string list = i.operands.substr(open);
    if (list.find('-') != std::string::npos)
      throw Refusal(hex(i.address) + ": a list that is not read: " + i.mnemonic + " " + i.operands);
    return static_cast<int>(words_in(list).size());
  }
  return row.per_word != 0 ? 2 : 1;
}

[[nodiscard]] bool is_of_stack(const Instruction& i) {
  return i.operands.find("[sp") != std::string::npos || i.operands.compare(0, 3, "sp!") == 0 ||
         i.mnemonic.compare(0, 3, "pop") == 0 || i.mnemonic.compare(0, 4, "vpop") == 0;
}

[[nodiscard]] bool names_core_register(const std::string& operands) {
  const std::vector<std::string> all = words_in(operands);
  return std::any_of(all.begin(), all.end(), [](const std::string& word) {
    return word == "sl" || word == "fp" || word == "ip" || word == "lr" ||
           (word.size() > 1 && word[0] == 'r' && std::isdigit(static_cast<unsigned char>(word[1])) != 0);
  });
}

/// Whether the next instruction waits for the result of this one.
[[nodiscard]] bool is_awaited(const Instruction& i, const Row& row, const Instruction* next) {
  if (row.kind != Kind::arithmetic && row.kind != Kind::compare) return false;
  if (next == nullptr || next->mnemonic.compare(0, 2, "it") == 0) return true;  // it may be folded into the next one
  if (row.kind == Kind::compare) return next->mnemonic.compare(0, 4, "vmrs") == 0;
  const std::set<int> result = float_words(i.operands.substr(0, i.operands.find(',')));
  const std::set<int> used = float_words(next->operands);
  return std::any_of(result.begin(), result.end(), [&](int w) { return used.count(w) != 0; });
}

}  // namespace

CortexM4Time cortex_m4_time(const Instruction& i, const Instruction* next) {
  const Row& row = row_of(i);
  const bool in_memory = row.kind == Kind::load || row.kind == Kind::store;
  const int words = in_memory ? words_moved(i, row) : 0;
  CortexM4Time time{row.cycles + row.per_word * words, 0, 0};
  if (row.kind == Kind::transfer && names_core_register(i.operands)) time.cycles += 1;
  if (is_awaited(i, row, next)) time.cycles += 1;
  const std::uint32_t end = i.address + i.size;
  time.fetched = (end + 3) / 4 - (i.address + 3) / 4;
  if (row.kind == Kind::load && !is_of_stack(i)) time.loaded = words;
  return time;
}

}  // namespace worst_tick
