#include <vtkCellArray.h>
#include <vtkCommand.h>
#include <vtkDataArray.h>
#include <vtkExecutive.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLPolyDataReader.h>

#include <new>

#include "planning/bones/mesh_formats.h"
#include "planning/geometry/error.h"

namespace arthronaut::bones {

namespace {

// VTK reports errors as events and goes on; without an observer it prints them.
class ErrorObserver : public vtkCommand {
 public:
  static ErrorObserver* New() { return new ErrorObserver; }
  void Execute(vtkObject*, unsigned long event, void* data) override {
    if (event != vtkCommand::ErrorEvent || !first_.empty()) return;
    first_ = data ? static_cast<const char*>(data) : "unknown error";
  }
  // The first error as one line: VTK puts the source file, the class and the address before it.
  [[nodiscard]] std::string first() const {
    std::string text = first_;
    if (const auto at = text.find("): "); at != std::string::npos) text.erase(0, at + 3);
    while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
  }
  [[nodiscard]] bool any() const { return !first_.empty(); }

 private:
  std::string first_;
};

// A count in a broken header must not become an allocation: zlib packs at most about 1030 bytes into one.
constexpr double kMostPerByte = 1100;

void refuse_impossible_counts(const std::filesystem::path& file, std::string_view text) {
  for (auto at = text.find("NumberOf"); at != std::string_view::npos; at = text.find("NumberOf", at + 1)) {
    const auto open = text.find_first_of("\"'", at);
    if (open == std::string_view::npos || open > at + 40) continue;
    const std::string_view value = text.substr(open + 1, text.find(text[open], open + 1) - open - 1);
    const auto number = number_from(value);
    if (!number || *number < 0 || *number > kMostPerByte * static_cast<double>(text.size())) {
      throw InvalidInput(file, "byte " + std::to_string(at), "a count that the file cannot hold");
    }
  }
}

// VTK makes room for as many corners as the offsets say, which no count in the header tells.
class BoundedReader : public vtkXMLPolyDataReader {
 public:
  static BoundedReader* New() { return new BoundedReader; }
  void bound(double most_values) { most_values_ = most_values; }

 protected:
  int ReadArrayValues(vtkXMLDataElement* element, vtkIdType at, vtkAbstractArray* array, vtkIdType start,
                      vtkIdType count, FieldType type) override {
    if (!vtkXMLPolyDataReader::ReadArrayValues(element, at, array, start, count, type)) return 0;
    const char* name = element->GetAttribute("Name");
    auto* offsets = vtkDataArray::SafeDownCast(array);
    if (!name || std::string_view(name) != "offsets" || !offsets) return 1;
    for (vtkIdType i = 0; i < offsets->GetNumberOfTuples(); ++i) {
      const double offset = offsets->GetComponent(i, 0);
      if (offset >= 0 && offset <= most_values_) continue;
      vtkErrorMacro("an offset that the file cannot hold");
      return 0;
    }
    return 1;
  }

 private:
  double most_values_ = 0;
};

template <typename Append>
void for_each_cell(const std::filesystem::path& file, vtkCellArray* cells, std::size_t vertex_count,
                   const Append& append_cell) {
  if (!cells) return;
  vtkDataArray* offsets = cells->GetOffsetsArray();
  vtkDataArray* indices = cells->GetConnectivityArray();
  const auto index_count = static_cast<double>(indices->GetNumberOfTuples());
  std::vector<std::int32_t> corners;
  for (vtkIdType cell = 0; cell + 1 < offsets->GetNumberOfTuples(); ++cell) {
    const double begin = offsets->GetComponent(cell, 0), end = offsets->GetComponent(cell + 1, 0);
    if (!(begin >= 0) || !(end >= begin) || !(end <= index_count)) {
      throw InvalidInput(file, "cell " + std::to_string(cell + 1), "its offsets are out of range");
    }
    corners.clear();
    for (auto i = static_cast<vtkIdType>(begin); i < static_cast<vtkIdType>(end); ++i) {
      const double vertex = indices->GetComponent(i, 0);
      if (!(vertex >= 0) || vertex >= static_cast<double>(vertex_count)) {
        throw InvalidInput(file, "cell " + std::to_string(cell + 1),
                           "refers to a vertex that is not among the " + std::to_string(vertex_count));
      }
      corners.push_back(static_cast<std::int32_t>(vertex));
    }
    append_cell(corners);
  }
}

// A field array called SPACE, or any text array that says SPACE=...
std::optional<Space> space_of_field(vtkFieldData* field) {
  for (int i = 0; field && i < field->GetNumberOfArrays(); ++i) {
    const auto* strings = vtkStringArray::SafeDownCast(field->GetAbstractArray(i));
    const char* name = field->GetAbstractArray(i)->GetName();
    if (!strings) continue;
    for (vtkIdType k = 0; k < strings->GetNumberOfValues(); ++k) {
      const std::string value = const_cast<vtkStringArray*>(strings)->GetValue(k);
      const bool is_named = name && equal_ignoring_case(name, "SPACE");
      if (const auto space = space_declared_in(is_named ? "SPACE=" + value : value)) return space;
    }
  }
  return std::nullopt;
}

}  // namespace

RawMesh parse_vtp(const std::filesystem::path& file, std::string_view text) {
  refuse_impossible_counts(file, text);
  vtkNew<ErrorObserver> errors;
  vtkNew<BoundedReader> reader;
  reader->bound(kMostPerByte * static_cast<double>(text.size()));
  reader->AddObserver(vtkCommand::ErrorEvent, errors);
  reader->AddObserver(vtkCommand::WarningEvent, errors);
  reader->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, errors);
  reader->SetReaderErrorObserver(errors);
  reader->SetParserErrorObserver(errors);
  reader->ReadFromInputStringOn();
  reader->SetInputString(std::string(text));
  try {
    reader->Update();
  } catch (const std::bad_alloc&) {
    throw InvalidInput(file, "", "asks for more memory than there is");
  }
  if (errors->any()) throw InvalidInput(file, "", "is not a whole VTP file: " + errors->first());
  vtkPolyData* data = reader->GetOutput();
  RawMesh raw;
  raw.format = "VTP";
  // Comments are not kept by VTK: the text before the data is searched.
  raw.declared_space = space_declared_in(text.substr(0, std::min<std::size_t>(text.size(), 4096)));
  if (const auto space = space_of_field(data->GetFieldData())) raw.declared_space = space;
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i) {
    raw.mesh.vertices_mm.emplace_back(Eigen::Map<const Eigen::Vector3d>(data->GetPoint(i)));
    if (!raw.mesh.vertices_mm.back().allFinite()) {
      throw InvalidInput(file, "vertex " + std::to_string(i + 1), "has a coordinate that is not finite");
    }
  }
  const std::size_t vertex_count = raw.mesh.vertices_mm.size();
  for_each_cell(file, data->GetPolys(), vertex_count,
                [&](const std::vector<std::int32_t>& corners) { append_polygon(raw.mesh, corners); });
  if (data->GetNumberOfStrips() > 0)
    throw InvalidInput(file, "", "holds triangle strips: save it as triangles");
  return raw;
}

}  // namespace arthronaut::bones
