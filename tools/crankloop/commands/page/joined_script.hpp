// ES modules as one script: from a disk a page may load no modules.
//
// What belongs here: what a module's text may say, and where its parts go. What does not: what the modules do.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace crankloop::program {

/// The text of a module by its name: "main.mjs", "../wasi.mjs".
using ModuleText = std::function<std::string_view(const std::string& name)>;

/// `entry` and all that it imports, each a function that is called once, in the order in which they need each other. A
/// module begins with imports by name, `import {a, b} from './other.mjs';`, and writes `export` before each declaration
/// that others use. Same modules, same bytes. Throws std::logic_error for what it does not understand, and for modules
/// that need each other in a ring.
[[nodiscard]] std::string joined_script(const std::string& entry, const ModuleText& text_of);

}  // namespace crankloop::program
