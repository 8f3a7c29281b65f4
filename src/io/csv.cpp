#include "io/csv.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>

#include "base/error.h"
#include "io/files.h"

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

std::string csv_line(std::span<const std::string> fields) {
  std::string line;
  for (std::size_t k = 0; k < fields.size(); ++k) line += (k > 0 ? "," : "") + csv_field(fields[k]);
  return line + '\n';
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

}  // namespace trackbed
