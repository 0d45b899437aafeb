#include "csv.hpp"

#include <stdexcept>

#include "number.hpp"

namespace crankloop::program {

CsvWriter::CsvWriter(Output& out, const std::vector<std::string>& header) : out_{out}, columns_{header.size()} {
  for (const std::string& name : header) cell(name);
  end_row();
}

void CsvWriter::cell(double value) { append(significant(value)); }
void CsvWriter::cell(float value) { append(significant(value)); }
void CsvWriter::cell(int value) { append(std::to_string(value)); }
void CsvWriter::cell(std::string_view text) { append(text); }

void CsvWriter::quoted_cell(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return append(text);
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  put(quoted + "\"");
}

void CsvWriter::append(std::string_view text) {
  if (text.find_first_of(",\"\r\n") != std::string_view::npos)
    throw std::logic_error("a CSV cell would need quotes: " + std::string(text));
  put(text);
}

void CsvWriter::put(std::string_view text) {
  if (filled_++ > 0) line_ += ',';
  line_ += text;
}

void CsvWriter::end_row() {
  if (filled_ != columns_) {
    throw std::logic_error("a CSV row has " + std::to_string(filled_) + " cells under " + std::to_string(columns_) +
                           " columns");
  }
  line_ += '\n';
  out_.write(line_);
  line_.clear();
  filled_ = 0;
}

}  // namespace crankloop::program
