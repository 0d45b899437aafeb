// `crankloop page FILE --out F.html`: the engine in a page that needs no network, no installation and no server.
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "../../command_line/commands.hpp"
#include "../../command_line/engine_argument.hpp"
#include "../../files/error.hpp"
#include "../../files/output_file.hpp"
#include "../../files/table_file.hpp"
#include "../../files/text_file.hpp"
#include "../../files/words.hpp"
#include "digest.hpp"
#include "joined_script.hpp"
#include "page_parts.hpp"

namespace crankloop::program {
namespace {

constexpr const char* kNoModule =
    "this program was built without the page's module. Install Debian's packages emscripten and node-acorn, run\n"
    "  cmake --preset page && cmake --build --preset page\n"
    "in crankloop's folder, and build the program again";

std::string replaced(std::string text, std::string_view what, std::string_view with) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + with.size()))
    text.replace(at, what.size(), with);
  return text;
}

std::string escaped(const std::string& text) {
  return replaced(replaced(replaced(text, "&", "&amp;"), "<", "&lt;"), "\"", "&quot;");
}

/// As a string of JSON within HTML: what stands in it is text and never markup.
std::string json_text(std::string_view text) {
  constexpr const char* kDigits = "0123456789abcdef";
  std::string json = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || c == '"' || c == '\\' || c == '<' || c == '>' || c == '&') {
      json += std::string("\\u00") + kDigits[byte >> 4] + kDigits[byte & 15u];
    } else {
      json += c;
    }
  }
  return json + "\"";
}

std::string_view text_of_part(const std::string& name) {
  const PagePart* part = find_page_part(name);
  if (part == nullptr) throw std::logic_error("the program carries no " + name);
  return part->text();
}

/// Text of a script block: nothing in it ends the block.
std::string script_block(const std::string& entry) {
  return replaced(replaced(joined_script(entry, text_of_part), "</", "<\\/"), "<!--", "<\\!--");
}

std::string base64_of_part(const std::string& name) {
  const PagePart* part = find_page_part(name);
  return part == nullptr ? "" : base64(part->text());
}

/// The engine file without its folder, and the tables that it names.
std::string source_of(const EngineFile& engine, const std::string& path) {
  const std::size_t slash = path.rfind('/');
  std::string json = "{\"path\":" + json_text(slash == std::string::npos ? path : path.substr(slash + 1));
  json += ",\"text\":" + json_text(read_file(path, kMaxEngineFileBytes).bytes) + ",\"files\":[";
  bool is_first = true;
  for (const SectionValues& section : engine.sections()) {
    for (const Value& value : section.values) {
      if (value.key->kind != Kind::path || !value.used || value.text.empty()) continue;
      const FileBytes table = read_file(in_folder(folder_of(path), value.text), kMaxTableBytes);
      json += (is_first ? "" : ",") + std::string("{\"name\":") + json_text(value.text) +
              ",\"text\":" + json_text(table.bytes) + "}";
      is_first = false;
    }
  }
  return json + "]}";
}

/// [["diesel_forces","0x..."],...] of the lines {"diesel_forces", 0x...}, of tests/target/golden_hashes.inc.
std::string golden_of(std::string_view lines) {
  std::string json;
  for (const std::string_view line : split(lines, '\n')) {
    const std::size_t quote = line.find('"'), hash = line.find("0x"), end = line.find('}');
    if (quote == std::string_view::npos || hash == std::string_view::npos || end == std::string_view::npos) continue;
    const std::string_view name = line.substr(quote + 1, line.find('"', quote + 1) - quote - 1);
    json += (json.empty() ? "[" : ",[") + json_text(name) + "," + json_text(line.substr(hash, end - hash)) + "]";
  }
  return "[" + json + "]";
}

/// The frame with its places filled in: %%TITLE%%.
std::string filled(std::string_view frame, const std::vector<std::pair<std::string_view, std::string>>& values) {
  std::string page;
  while (!frame.empty()) {
    const std::size_t begin = frame.find("%%");
    const std::size_t end = begin == std::string_view::npos ? begin : frame.find("%%", begin + 2);
    page += frame.substr(0, begin);
    if (end == std::string_view::npos) break;
    const std::string_view name = frame.substr(begin + 2, end - begin - 2);
    frame.remove_prefix(end + 2);
    const std::string* value = nullptr;
    for (const auto& [key, text] : values) {
      if (key == name) value = &text;
    }
    if (value == nullptr) throw std::logic_error("the page's frame has a place " + std::string(name));
    page += *value;
  }
  return page;
}

std::string page_of(const EngineFile& engine, const std::string& path) {
  const std::string script = script_block("main.mjs");
  const std::string style(text_of_part("page.css"));
  const auto by_digest = [](const std::string& text) { return "'sha256-" + base64(sha256(text)) + "'"; };
  const std::string policy = "default-src 'none'; script-src " + by_digest(script) +
                             " 'wasm-unsafe-eval'; worker-src blob:; style-src " + by_digest(style) +
                             "; img-src data: blob:; base-uri 'none'; form-action 'none'";
  const std::size_t slash = path.rfind('/');
  return filled(text_of_part("page.html"),
                {{"POLICY", policy},
                 {"TITLE", escaped(slash == std::string::npos ? path : path.substr(slash + 1))},
                 {"STYLE", style},
                 {"ENGINE", source_of(engine, path)},
                 {"GOLDEN", golden_of(text_of_part("golden_hashes.inc"))},
                 {"MODULE", base64_of_part("engine.wasm")},
                 {"DOUBLE", base64_of_part("engine_double.wasm")},
                 {"PROOF", base64_of_part("golden.wasm")},
                 {"WORKER", script_block("worker.mjs")},
                 {"SCRIPT", script}});
}

int run_page(const Arguments& arguments) {
  const EngineFile engine = read_engine_for_scenes(arguments, {"engine", "crank", "masses"});
  Output out(arguments.text("--out"));
  if (find_page_part("engine.wasm") == nullptr) throw std::runtime_error(kNoModule);
  out.write(page_of(engine, arguments.file()));
  out.finish();
  return kSuccess;
}

constexpr Option kPageOptions[] = {
    required(text("--out", "F.html", "the page to write, -o for short; opens in any browser, also from a disk")),
};

}  // namespace

const PagePart* find_page_part(std::string_view name) noexcept {
  for (std::size_t i = 0; i < kPagePartCount; ++i) {
    if (name == kPageParts[i].name) return &kPageParts[i];
  }
  return nullptr;
}

const Command kPage{
    "page",
    "the engine in an HTML page that runs it: moving parts, scopes, controls, redline; without a network",
    "FILE --out F.html",
    "crankloop page four_2000.ini --out engine.html",
    1,
    kPageOptions,
    run_page};

}  // namespace crankloop::program
