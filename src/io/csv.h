// Tables of numbers as text: one header with units, then rows.
#pragma once

#include <cstdio>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/units.h"

namespace trackbed {

/// A column: "time" in Dimension::time is headed "time [s]", one without unit "porosity [-]".
struct Column {
  std::string name;
  Dimension dimension = Dimension::none;
  bool is_text = false;  // holds words: headed by its name alone
};

/// A number or a word of a table.
using Cell = std::variant<double, std::string_view>;

/// A field as the CSV rules (RFC 4180) want it: in quotes where it holds a comma, a quote or a line break.
std::string csv_field(std::string_view text);

/// A row of such fields.
std::string csv_line(std::span<const std::string> fields);

/// Writes a table row by row. Every row is whole in the file as soon as add_row returns, so that a run that
/// is cut off leaves a table that can be read. Numbers are in SI and read back to the same bits.
class CsvWriter {
 public:
  /// Begins a new file. Throws RunError when that cannot be written.
  CsvWriter(const std::filesystem::path& path, std::vector<Column> columns);
  /// Goes on with a file of the same columns after `rows` rows; later ones, of a run that was cut off, are
  /// dropped. Throws RunError when the file has another header or fewer rows.
  static CsvWriter resume(const std::filesystem::path& path, std::vector<Column> columns, std::size_t rows);

  /// As many values as columns. Throws RunError when the disk is full.
  void add_row(std::span<const double> values);
  void add_row(std::span<const Cell> cells);
  void add_row(std::initializer_list<double> values) { add_row(std::span(values.begin(), values.size())); }

  std::size_t rows() const { return rows_; }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  CsvWriter(const std::filesystem::path& path, std::size_t n_columns, std::size_t rows, const char* mode);
  void write(const std::string& text);

  std::filesystem::path path_;
  std::size_t n_columns_ = 0, rows_ = 0;
  std::unique_ptr<std::FILE, Close> file_;
};

}  // namespace trackbed
