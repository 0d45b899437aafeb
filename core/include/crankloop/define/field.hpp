// The one list of fields that each struct of a definition has, its each_field().
//
//     Crank::each_field(visit, crank)           calls visit(read, "crank.bore_m", crank.bore_m), and so on
//     Crank::each_field(visit, crank, other)    calls visit(read, "crank.bore_m", crank.bore_m, other.bore_m):
//                                               `other` is any struct with fields of these names
//
// `read` is how many of it the tables read while the definition is as `crank` is: 1 or 0, of a list how many entries. A
// part that is a struct itself is visited as one. All code that goes through a definition uses these lists: the tables'
// fingerprint, the C interface, the program's engine file. That none lacks a field is checked where the fingerprint is
// made.
#pragma once

#include <type_traits>
#include <utility>

namespace crankloop {

/// Whether T is a struct with fields.
template <class T, class = void>
inline constexpr bool kHasFields = false;
template <class T>
inline constexpr bool kHasFields<T, std::void_t<decltype(T::each_field(0, std::declval<T&>()))>> = true;

}  // namespace crankloop

/// One field, in an each_field() of the struct `self`; PART is what its name begins with.
#define CRANKLOOP_FIELD(READ, PART, NAME) visit(READ, #PART "." #NAME, self.NAME, others.NAME...)
/// A part that has fields.
#define CRANKLOOP_PART(READ, NAME) visit(READ, #NAME, self.NAME, others.NAME...)
