// What the C header of an engine states about its scene, as text in an object file: the build reads it there, so that
// it works for any target machine, and fills port/c/engine_c.h.in with it. Structs are made from the list of
// variables.
//
// What belongs here: how C declares a variable. What does not: which there are (variables.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include <crankloop/c/engine.hpp>

namespace crankloop::c {

/// A kind of variable, "valve[#,#].lift_m": all those that differ in their indices alone.
struct Member {
  const char* name;
  const char* meaning;
  const char* type;
  bool is_phase;
  std::uint32_t counts[2];  ///< of the first # and of the second
};

[[nodiscard]] constexpr bool same(const char* a, const char* b) noexcept {
  while (*a != '\0' && *a == *b) ++a, ++b;
  return *a == *b;
}

/// The members of a struct, in its order.
struct Members {
  static constexpr std::size_t kMax = 256;
  Member all[kMax]{};
  std::size_t count = 0;
  std::size_t last = 0;

  template <class Value>
  constexpr void add(const detail::Variable& variable, const Value&) noexcept {
    constexpr detail::Storage kStorage = detail::kStorageOf<Value>;
    // That of the variable before, one further, or from the first on.
    std::size_t at = last;
    for (std::size_t tried = 0; tried < count && !same(all[at].name, variable.name); ++tried) at = (at + 1) % count;
    if (count == 0 || !same(all[at].name, variable.name)) {
      at = count++;
      all[at] = {variable.name,
                 variable.meaning,
                 kStorage == detail::Storage::real          ? "double"
                 : kStorage == detail::Storage::single_real ? "float"
                 : kStorage == detail::Storage::phase       ? "uint64_t"
                                                            : "uint32_t",
                 kStorage == detail::Storage::phase,
                 {0, 0}};
    }
    last = at;
    if (variable.first >= all[at].counts[0]) all[at].counts[0] = variable.first + 1;
    if (variable.second >= all[at].counts[1]) all[at].counts[1] = variable.second + 1;
  }
};

template <class Real, class S>
[[nodiscard]] constexpr Members input_members() noexcept {
  Members members;
  Input<Real, S> input{};
  const auto add = [&members](const detail::Variable& variable, auto& value) { members.add(variable, value); };
  detail::each_input<S>(add, input, OutputInC<Real, S>::kLargest);
  return members;
}
/// Those of the state, which are constant, first.
template <class Real, class S>
[[nodiscard]] constexpr Members output_members() noexcept {
  Members members;
  const State<Real, S> state{};
  Output<Real, S> output{};
  for (const bool of_state : {true, false}) {
    const auto add = [&members, of_state](const detail::Variable& variable, auto& value) {
      if (std::is_const_v<std::remove_reference_t<decltype(value)>> == of_state) members.add(variable, value);
    };
    detail::each_output<S>(add, state, output, OutputInC<Real, S>::kLargest);
    if (!of_state) detail::each_event<S>(add, output, OutputInC<Real, S>::kLargest);
  }
  return members;
}

/// " name=00000012" for each fact, then the structs; port/c/engine_c.cmake reads it. CMake takes ; [ and ] in a way
/// of its own, and a line's end would end the text: written $ < > and |.
class HeaderText {
 public:
  constexpr HeaderText(const char* name) noexcept : name_{name} {
    add("crankloop_facts_of_");
    add(name);
    add(":");
  }

  constexpr void fact(const char* name, std::size_t value) noexcept {
    add(" ");
    add(name);
    add("=");
    for (std::size_t digit = 100'000'000; digit > 0; digit /= 10) add(static_cast<char>('0' + value / digit % 10));
  }
  /// A struct and those that it is made of.
  constexpr void record(const char* name, const Members& members) noexcept {
    add(" ");
    add(name);
    add(":");
    records(members, 0, members.count, 0);
    if (members.count > 0) type(name, members, 0, members.count, 0);
  }
  constexpr void end() noexcept { add(" end"); }

 private:
  constexpr void add(char letter) noexcept {
    text_[length_++] = letter == ';' ? '$' : letter == '[' ? '<' : letter == ']' ? '>' : letter == '\n' ? '|' : letter;
  }
  constexpr void add(const char* words) noexcept {
    for (; *words != '\0'; ++words) add(*words);
  }
  constexpr void number(std::uint32_t value) noexcept {
    if (value >= 10) number(value / 10);
    add(static_cast<char>('0' + value % 10));
  }

  /// Behind the next '.' of a name from `begin` on; 0: there is none.
  [[nodiscard]] static constexpr std::size_t behind_record(const char* name, std::size_t begin) noexcept {
    for (std::size_t i = begin; name[i] != '\0'; ++i) {
      if (name[i] == '.') return i + 1;
    }
    return 0;
  }
  [[nodiscard]] static constexpr bool same_record(const char* a, const char* b, std::size_t length) noexcept {
    for (std::size_t i = 0; i < length; ++i) {
      if (a[i] != b[i]) return false;
    }
    return true;
  }
  /// Calls visit(from, to, behind) for each run of members from..to of one record whose name ends before `behind`; 0: a
  /// plain member.
  template <class Visit>
  static constexpr void each_run(const Members& m, std::size_t from, std::size_t to, std::size_t begin, Visit&& visit) {
    while (from < to) {
      const std::size_t behind = behind_record(m.all[from].name, begin);
      std::size_t next = from + 1;
      while (behind > 0 && next < to && same_record(m.all[from].name, m.all[next].name, behind)) ++next;
      visit(from, next, behind);
      from = next;
    }
  }

  // Of the members from..to, whose names begin alike up to `begin`:
  constexpr void records(const Members& m, std::size_t from, std::size_t to, std::size_t begin) noexcept {
    each_run(m, from, to, begin, [&](std::size_t first, std::size_t last, std::size_t behind) {
      if (behind == 0) return;
      records(m, first, last, behind);
      type(m.all[first].name, m, first, last, behind);
    });
  }
  constexpr void type(const char* path, const Members& m, std::size_t from, std::size_t to,
                      std::size_t begin) noexcept {
    add("typedef struct ");
    type_name(path, begin);
    add(" {\n");
    each_run(m, from, to, begin, [&](std::size_t first, std::size_t, std::size_t behind) {
      const Member& member = m.all[first];
      add("  ");
      if (behind > 0) {
        type_name(member.name, behind);
      } else {
        add(member.type);
      }
      add(" ");
      declarator(member, begin);
      add(";");
      if (behind == 0) add(" /* "), add(member.meaning), add(member.is_phase ? "; 2^64 = 720 deg */" : " */");
      add("\n");
    });
    add("} ");
    type_name(path, begin);
    add(";\n");
  }
  /// "trigger[#].edge[#]." of NAME: NAME_trigger_edge.
  constexpr void type_name(const char* path, std::size_t end) noexcept {
    add(name_);
    add("_");
    bool index = false;
    for (std::size_t i = 0; path[i] != '\0' && (end == 0 || i + 1 < end); ++i) {
      if (path[i] == '[') index = true;
      if (!index) add(path[i] == '.' ? '_' : path[i]);
      if (path[i] == ']') index = false;
    }
  }
  /// The part of the name from `begin` to its next '.', "valve[4][16]". An angle of a phase is told without its unit.
  constexpr void declarator(const Member& member, std::size_t begin) noexcept {
    std::size_t index = 0;
    std::size_t end = begin;
    while (member.name[end] != '\0' && member.name[end] != '.') ++end;
    if (member.is_phase) end -= 4;  // "_deg"
    for (std::size_t i = 0; i < end; ++i) {
      const char letter = member.name[i];
      if (letter == '#') {
        if (i >= begin) number(member.counts[index]);
        ++index;
      } else if (i >= begin && letter == ',') {
        add("][");
      } else if (i >= begin) {
        add(letter);
      }
    }
  }

  const char* name_;
  char text_[24000]{};
  std::size_t length_ = 0;
};

template <class Form>
[[nodiscard]] constexpr HeaderText header_text(const char* name) noexcept {
  using Real = typename Form::Real;
  using S = typename Form::Scene;
  HeaderText text(name);
  const Members output = output_members<Real, S>();
  text.fact("engine_words", (sizeof(typename Form::Object) + 7) / 8);
  text.fact("engine_alignment", alignof(typename Form::Object));
  text.fact("tables_words", (Form::kTablesBytes + 7) / 8);
  text.fact("made_tables", Form::kTablesBytes > 0);
  text.fact("compiled_tables", Form::kTablesBytes == 0);
  text.fact("saved_bytes", kSavedStateBytes<Real, S>);
  text.fact("turned_by_forces", detail::Needs<S>::crank_dynamics);
  text.fact("outputs", output.count > 0);
  text.record("input", input_members<Real, S>());
  text.record("output", output);
  text.end();
  return text;
}

}  // namespace crankloop::c
