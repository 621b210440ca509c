// Strict reading of comma-separated files with one header line. Columns are found by name, so that further
// columns may follow; every error names the file, the line and the column.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace arthronaut::files {

class CsvTable {
 public:
  // Throws IoError when the file cannot be read, InvalidInput when the header lacks a required column or a
  // row has another number of cells than the header. CRLF, a final empty line and the mark that spreadsheets
  // begin UTF-8 with are accepted.
  static CsvTable read(const std::filesystem::path& file, const std::vector<std::string>& required_columns);
  static CsvTable parse(std::string_view text, const std::filesystem::path& name,
                        const std::vector<std::string>& required_columns);

  [[nodiscard]] std::size_t row_count() const { return rows_.size(); }
  [[nodiscard]] bool has_column(std::string_view column) const;
  // Throw InvalidInput when the cell is not a finite number / an integer / one that an int holds.
  [[nodiscard]] double number(std::size_t row, std::string_view column) const;
  [[nodiscard]] std::optional<double> optional_number(std::size_t row,
                                                      std::string_view column) const;  // empty cell
  [[nodiscard]] std::int64_t integer(std::size_t row, std::string_view column) const;
  [[nodiscard]] int int32(std::size_t row, std::string_view column) const;
  [[nodiscard]] const std::string& text(std::size_t row, std::string_view column) const;
  [[noreturn]] void fail(std::size_t row, std::string_view column, const std::string& reason) const;

 private:
  [[nodiscard]] std::size_t column_index(std::string_view column) const;

  std::filesystem::path file_;
  std::vector<std::string> columns_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace arthronaut::files
