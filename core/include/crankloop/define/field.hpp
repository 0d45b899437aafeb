// The one list of fields that each struct of a definition has, its each_field().
//
//     Crank::each_field(visit, crank)           calls visit({read, "crank.bore_m", above(0).up_to(2)}, crank.bore_m),
//                                               and so on
//     Crank::each_field(visit, crank, other)    calls visit({...}, crank.bore_m, other.bore_m):
//                                               `other` is any struct with fields of these names
//
// A part that is a struct itself is visited as one. All code that goes through a definition uses these lists: its
// validation, the tables' fingerprint, the C interface, the program's engine file. That none lacks a field, and no
// number lacks its range, is checked where the fingerprint is made.
#pragma once

#include <type_traits>
#include <utility>

#include <crankloop/define/range.hpp>

namespace crankloop {

/// What a list says of a field.
struct ListedField {
  int read;  ///< how many of it the tables read while the definition is as it is: 1 or 0, of a list how many entries
  const char* name;
  Range range{};  ///< of a number that is read, and of each entry of a list; validate() has the rules between fields
};

/// Whether T is a struct with fields.
template <class T, class = void>
inline constexpr bool kHasFields = false;
template <class T>
inline constexpr bool kHasFields<T, std::void_t<decltype(T::each_field(0, std::declval<T&>()))>> = true;

}  // namespace crankloop

/// A number or a list of them, in an each_field() of the struct `self`; PART is what its name begins with.
#define CRANKLOOP_NUMBER(READ, PART, NAME, RANGE) \
  visit(::crankloop::ListedField{READ, #PART "." #NAME, RANGE}, self.NAME, others.NAME...)
/// A field that no range by itself bounds: a choice, rows, how many rows there are.
#define CRANKLOOP_FIELD(READ, PART, NAME) \
  visit(::crankloop::ListedField{READ, #PART "." #NAME}, self.NAME, others.NAME...)
/// A part that has fields.
#define CRANKLOOP_PART(READ, NAME) visit(::crankloop::ListedField{READ, #NAME}, self.NAME, others.NAME...)
