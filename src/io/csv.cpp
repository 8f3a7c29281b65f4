#include "io/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <utility>

#include "base/error.h"
#include "io/files.h"
#include "io/nearest.h"

namespace trackbed {
namespace {

std::string header_of(const std::vector<Column>& columns) {
  std::string line;
  for (const Column& column : columns) {
    if (!line.empty()) line += ',';
    line += csv_field(column.is_text ? column.name
                                     : fmt::format("{} [{}]", column.name, si_unit_of(column.dimension)));
  }
  return line + '\n';
}

/// The fields of a line, out of their quotes, without blanks around them.
std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields(1);
  bool is_quoted = false;
  for (std::size_t k = 0; k < line.size(); ++k) {
    const char c = line[k];
    if (c == '"' && is_quoted && k + 1 < line.size() && line[k + 1] == '"')
      fields.back() += line[++k];
    else if (c == '"')
      is_quoted = !is_quoted;
    else if (c == ',' && !is_quoted)
      fields.emplace_back();
    else
      fields.back() += c;
  }
  for (std::string& field : fields) {
    field.erase(field.find_last_not_of(" \t\r") + 1);
    field.erase(0, field.find_first_not_of(" \t"));
  }
  return fields;
}

}  // namespace

std::string csv_field(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string field = "\"";
  for (char c : text) {
    if (c == '"') field += '"';
    field += c;
  }
  return field + '"';
}

CsvWriter::CsvWriter(const std::filesystem::path& path, std::size_t n_columns, std::size_t rows,
                     const char* mode)
    : path_(path), n_columns_(n_columns), rows_(rows), file_(std::fopen(path.c_str(), mode)) {
  if (!file_) throw RunError(fmt::format("{}: cannot be written: {}", path.string(), std::strerror(errno)));
}

CsvWriter::CsvWriter(const std::filesystem::path& path, std::vector<Column> columns)
    : CsvWriter(path, columns.size(), 0, "wb") {
  write(header_of(columns));
}

CsvWriter CsvWriter::resume(const std::filesystem::path& path, std::vector<Column> columns,
                            std::size_t rows) {
  const std::string old = read_file(path);
  const std::string header = header_of(columns);
  if (!old.starts_with(header))
    throw RunError(fmt::format("{}: cannot go on: it has other columns", path.string()));
  std::size_t end = header.size();
  for (std::size_t i = 0; i < rows; ++i) {
    const std::size_t line_end = old.find('\n', end);
    if (line_end == std::string::npos)
      throw RunError(fmt::format("{}: cannot go on: it has {} rows of the {} that the run has written",
                                 path.string(), i, rows));
    end = line_end + 1;
  }
  std::error_code error;
  std::filesystem::resize_file(path, end, error);
  if (error) throw RunError(fmt::format("{}: cannot be written: {}", path.string(), error.message()));
  return CsvWriter(path, columns.size(), rows, "ab");
}

void CsvWriter::add_row(std::span<const double> values) {
  add_row(std::vector<Cell>(values.begin(), values.end()));
}

void CsvWriter::add_row(std::span<const Cell> cells) {
  if (cells.size() != n_columns_)
    throw std::logic_error(
        fmt::format("{}: {} values for {} columns", path_.string(), cells.size(), n_columns_));
  std::string line;
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const Cell& cell = cells[k];
    if (k > 0) line += ',';
    if (const double* number = std::get_if<double>(&cell))
      line += fmt::format("{}", *number);
    else
      line += csv_field(std::get<std::string_view>(cell));
  }
  write(line + '\n');
  ++rows_;
}

void CsvWriter::write(const std::string& text) {
  const bool whole = std::fwrite(text.data(), 1, text.size(), file_.get()) == text.size();
  if (!whole || std::fflush(file_.get()) != 0)
    throw RunError(fmt::format("{}: cannot be written: {}", path_.string(), std::strerror(errno)));
}

CsvTable::CsvTable(const std::filesystem::path& path) : path_(path) {
  std::istringstream text(read_file(path));
  std::string line;
  for (std::size_t number = 1; std::getline(text, line); ++number) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    std::vector<std::string> fields = fields_of(line);
    if (names_.empty()) {
      for (const std::string& heading : fields) {
        const std::size_t bracket = heading.ends_with(']') ? heading.rfind(" [") : std::string::npos;
        names_.push_back(heading.substr(0, bracket));
        units_.push_back(
            bracket == std::string::npos ? "" : heading.substr(bracket + 2, heading.size() - bracket - 3));
      }
    } else if (fields.size() == names_.size()) {
      rows_.push_back(std::move(fields));
    } else {
      throw InputError(fmt::format("{}:{}: {} fields under {} headings", path.string(), number, fields.size(),
                                   names_.size()));
    }
  }
  if (names_.empty()) throw InputError(fmt::format("{}: there is no table in it", path.string()));
}

int CsvTable::find(std::string_view column) const {
  const auto found = std::ranges::find(names_, column);
  return found == names_.end() ? -1 : static_cast<int>(found - names_.begin());
}

std::size_t CsvTable::require(std::string_view column) const {
  const int found = find(column);
  if (found < 0)
    throw InputError(fmt::format("{}: there is no column {}\n  hint: {}", path_.string(), column,
                                 known_words(std::string(column), names_)));
  return static_cast<std::size_t>(found);
}

std::vector<double> CsvTable::numbers(std::string_view column, Dimension dimension) const {
  const std::size_t k = require(column);
  double unit = 1;
  if (!units_[k].empty() && units_[k] != "-") {
    const auto read = parse_quantity("1 " + units_[k], dimension);
    if (const auto* wrong = std::get_if<std::string>(&read))
      throw InputError(fmt::format("{}: the column {}: {}", path_.string(), column, *wrong));
    unit = std::get<double>(read);
  }
  std::vector<double> numbers;
  for (const auto& row : rows_) {
    const char* start = row[k].c_str();
    char* end = nullptr;
    const double number = std::strtod(start, &end);
    if (end == start || *end != '\0')
      throw InputError(fmt::format("{}: there is no number in row {} of the column {}", path_.string(),
                                   numbers.size() + 1, column));
    numbers.push_back(number * unit);
  }
  return numbers;
}

std::vector<std::string> CsvTable::texts(std::string_view column) const {
  const std::size_t k = require(column);
  std::vector<std::string> texts;
  for (const auto& row : rows_) texts.push_back(row[k]);
  return texts;
}

}  // namespace trackbed
