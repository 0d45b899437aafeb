// What `crankloop page` is made of: modules joined into one script, base64, SHA-256, and the page's frame.
#include <gtest/gtest.h>

#include <map>
#include <stdexcept>
#include <string>

#include "crankloop/commands/page/digest.hpp"
#include "crankloop/commands/page/joined_script.hpp"
#include "crankloop/commands/page/page_parts.hpp"

namespace crankloop::program::page_command_test {
namespace {

using Modules = std::map<std::string, std::string>;

std::string joined(const Modules& modules) {
  return joined_script("main.mjs",
                       [&modules](const std::string& name) -> std::string_view { return modules.at(name); });
}

TEST(JoinedScript, CallsEachModuleOnceBehindThoseThatItNeeds) {
  EXPECT_EQ(joined({{"main.mjs",
                     "// The page.\n\nimport {a} from './a.mjs';\nimport {b,\n  c} from './b.mjs';\n\na(b, c);\n"},
                    {"a.mjs", "import {c} from './b.mjs';\nexport function a() { return c; }\n"},
                    {"b.mjs", "export const b = 1;\nexport class c {}\nexport async function* d() {}\n"}}),
            "(() => {\n'use strict';\n"
            "const m_b_mjs = (() => {\nconst b = 1;\nclass c {}\nasync function* d() {}\nreturn {b, c, d};\n})();\n"
            "const m_a_mjs = (() => {\nconst {c} = m_b_mjs;\nfunction a() { return c; }\nreturn {a};\n})();\n"
            "const m_main_mjs = (() => {\nconst {a} = m_a_mjs;\nconst {b,   c} = m_b_mjs;\n// The page.\n\n\na(b, "
            "c);\nreturn {};\n})();\n"
            "})();\n");
}

TEST(JoinedScript, RefusesWhatItDoesNotUnderstand) {
  for (const char* text : {"import all from './a.mjs';\n", "import * as a from './a.mjs';\n", "import './a.mjs';\n",
                           "import {a as b} from './a.mjs';\n", "export default 1;\n", "export {a};\n"})
    EXPECT_THROW((void)joined({{"main.mjs", text}, {"a.mjs", ""}}), std::logic_error) << text;
  EXPECT_THROW(
      (void)joined({{"main.mjs", "import {a} from './a.mjs';\n"}, {"a.mjs", "import {b} from './main.mjs';\n"}}),
      std::logic_error);
}

TEST(Base64, HasTheExamplesOfItsStandard) {
  const char* kExamples[][2] = {{"", ""},
                                {"f", "Zg=="},
                                {"fo", "Zm8="},
                                {"foo", "Zm9v"},
                                {"foob", "Zm9vYg=="},
                                {"fooba", "Zm9vYmE="},
                                {"foobar", "Zm9vYmFy"}};
  for (const auto& [bytes, text] : kExamples) EXPECT_EQ(base64(bytes), text);
  EXPECT_EQ(base64(std::string("\xFF\x00\xFE", 3)), "/wD+");
}

TEST(Sha256, HasTheExamplesOfItsStandard) {
  const auto hex = [](const std::string& bytes) {
    std::string text;
    for (const char c : bytes) {
      text += "0123456789abcdef"[static_cast<unsigned char>(c) >> 4];
      text += "0123456789abcdef"[static_cast<unsigned char>(c) & 15u];
    }
    return text;
  };
  EXPECT_EQ(hex(sha256("")), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(hex(sha256("abc")), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(hex(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq")),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(hex(sha256(std::string(1000000, 'a'))), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(PageParts, HaveTheScriptsStyleAndFrameOfThePage) {
  for (const char* name : {"main.mjs", "worker.mjs", "../wasi.mjs", "page.css", "page.html", "golden_hashes.inc"}) {
    const PagePart* part = find_page_part(name);
    ASSERT_NE(part, nullptr) << name;
    EXPECT_GT(part->size, 100u) << name;
  }
  EXPECT_EQ(find_page_part("no.mjs"), nullptr);
}

}  // namespace
}  // namespace crankloop::program::page_command_test
