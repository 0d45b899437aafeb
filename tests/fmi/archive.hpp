// A reader of FMU archives and of the XML in them, for tests: strict, so that what it reads any importer can.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace fmu {

/// Throws with what is wrong.
inline void demand(bool good, const std::string& what) {
  if (!good) throw std::runtime_error(what);
}

/// CRC-32 bit by bit, as its definition says: not the library's.
inline std::uint32_t crc32(const std::string& bytes) {
  std::uint32_t sum = ~std::uint32_t{0};
  for (const char c : bytes) {
    sum ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) sum = (sum >> 1) ^ ((sum & 1u) != 0 ? 0xEDB88320u : 0u);
  }
  return ~sum;
}

class Archive {
 public:
  explicit Archive(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    bytes_.assign(std::istreambuf_iterator<char>(in), {});
    demand(bytes_.size() >= 22, path + " is no archive");
    const std::size_t end = bytes_.size() - 22;
    demand(number(end, 4) == 0x06054B50, "no end of the central directory, or a comment behind it");
    const std::size_t count = number(end + 8, 2);
    demand(number(end + 4, 4) == 0 && number(end + 10, 2) == count, "archive on several disks");
    std::size_t at = number(end + 16, 4);
    demand(at + number(end + 12, 4) == end, "the directory does not end where the archive's end begins");
    std::size_t next_local = 0;
    for (std::size_t i = 0; i < count; ++i) {
      demand(number(at, 4) == 0x02014B50, "no entry of the central directory");
      const std::size_t name_size = number(at + 28, 2);
      demand(number(at + 30, 2) == 0 && number(at + 32, 2) == 0, "extra field or comment in the directory");
      demand(number(at + 38, 4) == 0, "attributes of a file system");
      const std::string name = bytes_.substr(at + 46, name_size);
      const std::size_t local = number(at + 42, 4);
      demand(local == next_local, name + ": bytes between the files");
      demand(number(local, 4) == 0x04034B50, name + ": no local header");
      demand(bytes_.compare(local + 4, 26, bytes_, at + 6, 26) == 0, name + ": local and central header differ");
      demand(number(local + 4, 2) == 10, name + ": needs more than version 1.0");
      demand(number(local + 6, 2) == 0 && number(local + 8, 2) == 0, name + ": flags, or not stored");
      demand(number(local + 10, 4) == 0x00210000, name + ": not dated 1980-01-01");
      demand(number(local + 28, 2) == 0, name + ": extra field");
      const std::size_t size = number(local + 18, 4);
      demand(size == number(local + 22, 4), name + ": stored in another size");
      demand(bytes_.compare(local + 30, name_size, name) == 0, name + ": another name in its local header");
      const std::string content = bytes_.substr(local + 30 + name_size, size);
      demand(content.size() == size && crc32(content) == number(local + 14, 4), name + ": damaged");
      demand(files.emplace(name, content).second, name + " twice");
      names.push_back(name);
      next_local = local + 30 + name_size + size;
      at += 46 + name_size;
    }
    demand(at == end && next_local == number(end + 16, 4), "bytes between the files and their directory");
  }

  std::map<std::string, std::string> files;
  std::vector<std::string> names;  ///< in their order

 private:
  [[nodiscard]] std::size_t number(std::size_t at, std::size_t size) const {
    demand(at + size <= bytes_.size(), "the archive is cut off");
    std::size_t value = 0;
    for (std::size_t i = size; i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes_[at + i]);
    return value;
  }
  std::string bytes_;
};

/// An element of XML: no text, no namespaces, no comments.
struct Element {
  std::string name;
  std::map<std::string, std::string> attributes;
  std::vector<Element> children;

  [[nodiscard]] bool has(const std::string& key) const { return attributes.count(key) != 0; }
  [[nodiscard]] std::string operator[](const std::string& key) const {
    const auto found = attributes.find(key);
    return found == attributes.end() ? std::string() : found->second;
  }
  [[nodiscard]] const Element& child(const std::string& wanted) const {
    for (const Element& one : children) {
      if (one.name == wanted) return one;
    }
    throw std::runtime_error("<" + name + "> has no <" + wanted + ">");
  }
};

class XmlReader {
 public:
  explicit XmlReader(const std::string& text) : text_{text} {
    const auto is_ascii = [](char c) { return (c >= ' ' && c <= '~') || c == '\n'; };
    demand(std::all_of(text.begin(), text.end(), is_ascii), "XML that is not ASCII");
    take("<?xml version=\"1.0\" encoding=\"UTF-8\"?>");
  }
  [[nodiscard]] Element document() {
    Element root = element();
    blank();
    demand(at_ == text_.size(), "text behind the document's element");
    return root;
  }

 private:
  void blank() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\n')) ++at_;
  }
  [[nodiscard]] bool sees(const std::string& word) const { return text_.compare(at_, word.size(), word) == 0; }
  void take(const std::string& word) {
    demand(sees(word), "'" + word + "' expected before '" + text_.substr(at_, 40) + "'");
    at_ += word.size();
  }
  [[nodiscard]] std::string word() {
    const std::size_t from = at_;
    while (at_ < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[at_])) != 0 || text_[at_] == '_'))
      ++at_;
    demand(at_ > from, "a name expected before '" + text_.substr(from, 40) + "'");
    return text_.substr(from, at_ - from);
  }
  [[nodiscard]] std::string value() {
    static const std::map<std::string, char> kEntities = {{"amp", '&'}, {"lt", '<'}, {"gt", '>'}, {"quot", '"'}};
    std::string out;
    take("\"");
    for (; !sees("\""); ++at_) {
      demand(at_ < text_.size() && text_[at_] != '<', "'<' in an attribute, or no end of it");
      if (text_[at_] != '&') {
        out += text_[at_];
        continue;
      }
      const std::size_t end = text_.find(';', at_);
      demand(end != std::string::npos, "& without ;");
      out += kEntities.at(text_.substr(at_ + 1, end - at_ - 1));
      at_ = end;
    }
    take("\"");
    return out;
  }
  [[nodiscard]] Element element() {
    blank();
    take("<");
    Element e;
    e.name = word();
    for (blank(); !sees("/") && !sees(">"); blank()) {
      const std::string key = word();
      take("=");
      demand(e.attributes.emplace(key, value()).second, "attribute " + key + " twice in <" + e.name + ">");
    }
    if (sees("/")) {
      take("/>");
      return e;
    }
    take(">");
    for (blank(); !sees("</"); blank()) e.children.push_back(element());
    take("</" + e.name + ">");
    return e;
  }

  const std::string& text_;
  std::size_t at_ = 0;
};

}  // namespace fmu
