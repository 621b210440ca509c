#include "planning/files/csv_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "planning/files/atomic_file.h"
#include "planning/geometry/error.h"

namespace arthronaut::files {

namespace {

std::vector<std::string> split(std::string_view line) {
  std::vector<std::string> cells;
  for (;;) {
    const auto comma = line.find(',');
    std::string_view cell = line.substr(0, comma);
    while (!cell.empty() && (cell.front() == ' ' || cell.front() == '\t')) cell.remove_prefix(1);
    while (!cell.empty() && (cell.back() == ' ' || cell.back() == '\t')) cell.remove_suffix(1);
    cells.emplace_back(cell);
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

}  // namespace

CsvTable CsvTable::read(const std::filesystem::path& file, const std::vector<std::string>& required_columns) {
  return parse(read_text(file), file, required_columns);
}

CsvTable CsvTable::parse(std::string_view text, const std::filesystem::path& name,
                         const std::vector<std::string>& required_columns) {
  CsvTable table;
  table.file_ = name;
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  if (text.find('\n') == std::string_view::npos && text.find('\r') < text.size() - 1)
    throw InvalidInput(name, "line 1", "its lines end in carriage returns alone: line feeds are expected");
  bool is_header = true;
  for (std::size_t line_number = 1; !text.empty(); ++line_number) {
    const auto end = text.find('\n');
    std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    if (line.empty() && text.empty()) break;
    auto cells = split(line);
    if (is_header) {
      // As spreadsheets save it where the comma is the decimal sign.
      if (cells.size() == 1 && cells[0].find_first_of(";\t") != std::string::npos)
        throw InvalidInput(name, "line 1",
                           "its columns are separated by " +
                               std::string(cells[0].find(';') != std::string::npos ? "semicolons" : "tabs") +
                               ": commas are expected, and a point in numbers");
      table.columns_ = std::move(cells);
      is_header = false;
      continue;
    }
    if (cells.size() != table.columns_.size()) {
      throw InvalidInput(name, "line " + std::to_string(line_number),
                         "has " + std::to_string(cells.size()) + " cells, the header has " +
                             std::to_string(table.columns_.size()));
    }
    table.rows_.push_back(std::move(cells));
  }
  if (is_header) throw InvalidInput(name, "line 1", "is empty, expected a header");
  for (const auto& column : required_columns) {
    if (!table.has_column(column)) throw InvalidInput(name, "line 1", "has no column \"" + column + "\"");
  }
  return table;
}

bool CsvTable::has_column(std::string_view column) const {
  return std::find(columns_.begin(), columns_.end(), column) != columns_.end();
}

std::size_t CsvTable::column_index(std::string_view column) const {
  const auto found = std::find(columns_.begin(), columns_.end(), column);
  if (found == columns_.end())
    throw InvalidInput(file_, "line 1", "has no column \"" + std::string(column) + "\"");
  return static_cast<std::size_t>(found - columns_.begin());
}

const std::string& CsvTable::text(std::size_t row, std::string_view column) const {
  return rows_.at(row)[column_index(column)];
}

void CsvTable::fail(std::size_t row, std::string_view column, const std::string& reason) const {
  throw InvalidInput(file_, "line " + std::to_string(row + 2) + ", column " + std::string(column), reason);
}

double CsvTable::number(std::size_t row, std::string_view column) const {
  const std::string& cell = text(row, column);
  double value = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc() || end != cell.data() + cell.size())
    fail(row, column, "\"" + cell + "\" is not a number");
  if (!std::isfinite(value)) fail(row, column, "must be finite");
  return value;
}

std::optional<double> CsvTable::optional_number(std::size_t row, std::string_view column) const {
  if (text(row, column).empty()) return std::nullopt;
  return number(row, column);
}

std::int64_t CsvTable::integer(std::size_t row, std::string_view column) const {
  const std::string& cell = text(row, column);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc() || end != cell.data() + cell.size())
    fail(row, column, "\"" + cell + "\" is not an integer");
  return value;
}

int CsvTable::int32(std::size_t row, std::string_view column) const {
  const std::int64_t value = integer(row, column);
  if (!std::in_range<int>(value)) fail(row, column, std::to_string(value) + " is out of range");
  return static_cast<int>(value);
}

}  // namespace arthronaut::files
