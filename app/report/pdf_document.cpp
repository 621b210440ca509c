#include "app/report/pdf_document.h"

#include <hpdf.h>

#include <algorithm>
#include <numeric>
#include <span>
#include <utility>

#include "app/report/pdf_text_map.h"
#include "planning/files/atomic_file.h"
#include "planning/geometry/error.h"

namespace arthronaut::report {

namespace {

constexpr double kPointsPerMm = 72.0 / 25.4;
// Debian's fonts-dejavu-core. libharu embeds TrueType alone, which rules out the window's OpenType fonts.
constexpr const char* kRegularFont = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
constexpr const char* kBoldFont = "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf";

// libharu calls back into C: the error is kept and thrown once we are out of it again.
struct Failure {
  HPDF_STATUS status = HPDF_OK;
};

void remember(HPDF_STATUS error, HPDF_STATUS, void* failure) {
  auto& kept = *static_cast<Failure*>(failure);
  if (kept.status == HPDF_OK) kept.status = error;
}

}  // namespace

struct PdfDocument::Pdf {
  Failure failure;
  HPDF_Doc document = nullptr;
  HPDF_Page page = nullptr;
  HPDF_Font regular = nullptr, bold = nullptr;

  PaperSize paper;

  Pdf(const std::string& title, const PaperSize& of) : paper(of) {
    document = HPDF_New(remember, &failure);
    if (document == nullptr) throw IoError("the PDF writer could not be started");
    HPDF_UseUTFEncodings(document);
    HPDF_SetCompressionMode(document, HPDF_COMP_ALL);
    regular = load(kRegularFont);
    bold = load(kBoldFont);
    HPDF_SetCurrentEncoder(document, "UTF-8");
    HPDF_SetInfoAttr(document, HPDF_INFO_TITLE, title.c_str());
    HPDF_SetInfoAttr(document, HPDF_INFO_CREATOR, "Arthronaut");
  }
  ~Pdf() { HPDF_Free(document); }

  HPDF_Font load(const char* file) {
    const char* name =
        std::filesystem::exists(file) ? HPDF_LoadTTFontFromFile(document, file, HPDF_TRUE) : nullptr;
    if (name == nullptr) throw IoError(file, "cannot be read (package fonts-dejavu-core)");
    return HPDF_GetFont(document, name, "UTF-8");
  }
  void check() const {
    if (failure.status != HPDF_OK) {
      throw IoError("the PDF writer failed with error " + std::to_string(failure.status));
    }
  }
  [[nodiscard]] HPDF_REAL from_top(double mm) const {
    return static_cast<HPDF_REAL>((paper.height_mm - mm) * kPointsPerMm);
  }
  void use(const TextStyle& style) const {
    HPDF_Page_SetFontAndSize(page, style.bold ? bold : regular, static_cast<HPDF_REAL>(style.size_pt));
    HPDF_Page_SetRGBFill(page, static_cast<HPDF_REAL>(style.ink.red), static_cast<HPDF_REAL>(style.ink.green),
                         static_cast<HPDF_REAL>(style.ink.blue));
  }
};

namespace {

HPDF_REAL points(double mm) { return static_cast<HPDF_REAL>(mm * kPointsPerMm); }

// Where the letter after the one at `at` begins, in UTF-8.
std::size_t next_letter(const std::string& text, std::size_t at) {
  do ++at;
  while (at < text.size() && (static_cast<unsigned char>(text[at]) & 0xC0U) == 0x80U);
  return at;
}

constexpr double kCellPadMm = 1.5, kRowGap = 0.35;  // the gap in lines

TextStyle cell_style(bool is_heading) {
  return {.size_pt = 8.8, .bold = is_heading, .ink = is_heading ? kAccent : kBlack};
}

std::string joined(std::span<const std::string> lines) {
  std::string text;
  for (const std::string& line : lines) text += (text.empty() ? "" : " ") + line;
  return text;
}

}  // namespace

PdfDocument::PdfDocument(const std::string& title, Paper paper)
    : pdf_(std::make_unique<Pdf>(title, size_of(paper))) {}
PdfDocument::~PdfDocument() = default;

double PdfDocument::width_mm() const { return pdf_->paper.width_mm; }
double PdfDocument::height_mm() const { return pdf_->paper.height_mm; }

void PdfDocument::add_page() {
  pdf_->page = HPDF_AddPage(pdf_->document);
  pdf_->check();
  HPDF_Page_SetWidth(pdf_->page, points(width_mm()));
  HPDF_Page_SetHeight(pdf_->page, points(height_mm()));
}

void PdfDocument::text(double x_mm, double y_mm, std::string_view text, const TextStyle& style) {
  pdf_->use(style);
  HPDF_Page_BeginText(pdf_->page);
  HPDF_Page_TextOut(pdf_->page, points(x_mm), pdf_->from_top(y_mm), std::string(text).c_str());
  HPDF_Page_EndText(pdf_->page);
  pdf_->check();
}

double PdfDocument::text_width_mm(std::string_view text, const TextStyle& style) {
  pdf_->use(style);
  return HPDF_Page_TextWidth(pdf_->page, std::string(text).c_str()) / kPointsPerMm;
}

double PdfDocument::line_height_mm(const TextStyle& style) { return 1.35 * style.size_pt / kPointsPerMm; }

std::vector<std::string> PdfDocument::lines_of(std::string_view text, double width_mm,
                                               const TextStyle& style) {
  std::vector<std::string> lines;
  std::string line;
  const auto fits = [&](const std::string& words) { return text_width_mm(words, style) <= width_mm; };
  while (!text.empty()) {
    const auto space = text.find(' ');
    std::string word(text.substr(0, space));
    text.remove_prefix(space == std::string_view::npos ? text.size() : space + 1);
    std::string longer = line.empty() ? word : line + " " + word;
    if (fits(longer)) {
      line = std::move(longer);
      continue;
    }
    if (!line.empty()) lines.push_back(std::move(line));
    while (!fits(word)) {
      std::size_t end = next_letter(word, 0);
      while (end < word.size() && fits(word.substr(0, next_letter(word, end)))) end = next_letter(word, end);
      if (end >= word.size()) break;  // a single letter
      lines.push_back(word.substr(0, end));
      word.erase(0, end);
    }
    line = std::move(word);
  }
  lines.push_back(std::move(line));
  return lines;
}

double PdfDocument::paragraph(double x_mm, double y_mm, double width_mm, std::string_view text,
                              const TextStyle& style) {
  for (const std::string& line : lines_of(text, width_mm, style)) {
    if (!line.empty()) this->text(x_mm, y_mm, line, style);
    y_mm += line_height_mm(style);
  }
  return y_mm;
}

double PdfDocument::paragraph_height_mm(double width_mm, std::string_view text, const TextStyle& style) {
  return static_cast<double>(lines_of(text, width_mm, style).size()) * line_height_mm(style);
}

std::string PdfDocument::cut_to(std::string_view text, double width_mm, const TextStyle& style) {
  std::string whole(text);
  if (text_width_mm(whole, style) <= width_mm) return whole;
  std::size_t end = 0;
  for (std::size_t next = next_letter(whole, 0);
       next < whole.size() && text_width_mm(whole.substr(0, next) + "\u2026", style) <= width_mm;
       next = next_letter(whole, next))
    end = next;
  return whole.substr(0, end) + "\u2026";
}

void PdfDocument::line(double x0_mm, double y0_mm, double x1_mm, double y1_mm, double width_mm,
                       const Ink& ink) {
  HPDF_Page_SetRGBStroke(pdf_->page, static_cast<HPDF_REAL>(ink.red), static_cast<HPDF_REAL>(ink.green),
                         static_cast<HPDF_REAL>(ink.blue));
  HPDF_Page_SetLineWidth(pdf_->page, points(width_mm));
  HPDF_Page_MoveTo(pdf_->page, points(x0_mm), pdf_->from_top(y0_mm));
  HPDF_Page_LineTo(pdf_->page, points(x1_mm), pdf_->from_top(y1_mm));
  HPDF_Page_Stroke(pdf_->page);
  pdf_->check();
}

void PdfDocument::filled_rectangle(double x_mm, double y_mm, double width_mm, double height_mm,
                                   const Ink& ink) {
  HPDF_Page_SetRGBFill(pdf_->page, static_cast<HPDF_REAL>(ink.red), static_cast<HPDF_REAL>(ink.green),
                       static_cast<HPDF_REAL>(ink.blue));
  HPDF_Page_Rectangle(pdf_->page, points(x_mm), pdf_->from_top(y_mm + height_mm), points(width_mm),
                      points(height_mm));
  HPDF_Page_Fill(pdf_->page);
  pdf_->check();
}

double PdfDocument::image(double x_mm, double y_mm, double width_mm, const std::vector<std::uint8_t>& rgb,
                          int width, int height) {
  const HPDF_Image image = HPDF_LoadRawImageFromMem(pdf_->document, rgb.data(), static_cast<HPDF_UINT>(width),
                                                    static_cast<HPDF_UINT>(height), HPDF_CS_DEVICE_RGB, 8);
  pdf_->check();
  const double height_mm = width_mm * height / width;
  HPDF_Page_DrawImage(pdf_->page, image, points(x_mm), pdf_->from_top(y_mm + height_mm), points(width_mm),
                      points(height_mm));
  pdf_->check();
  return height_mm;
}

double PdfDocument::row_height_mm(const std::vector<double>& widths_mm, const std::vector<std::string>& cells,
                                  bool is_heading) {
  const TextStyle style = cell_style(is_heading);
  double height_mm = line_height_mm(style);
  for (std::size_t c = 0; c < cells.size() && c < widths_mm.size(); ++c)
    height_mm = std::max(height_mm, paragraph_height_mm(widths_mm[c] - 2 * kCellPadMm, cells[c], style));
  return height_mm + kRowGap * line_height_mm(style);
}

std::vector<std::string> PdfDocument::take_lines(const std::vector<double>& widths_mm,
                                                 std::vector<std::string>& cells, double height_mm) {
  const TextStyle style = cell_style(false);
  const double room = height_mm / line_height_mm(style) - kRowGap;
  if (!(room >= 1)) return {};
  std::vector<std::string> taken(cells.size());
  for (std::size_t c = 0; c < cells.size() && c < widths_mm.size(); ++c) {
    const std::vector<std::string> lines = lines_of(cells[c], widths_mm[c] - 2 * kCellPadMm, style);
    const std::span<const std::string> all(lines);
    const std::size_t count = std::min(lines.size(), static_cast<std::size_t>(room));
    taken[c] = joined(all.first(count));
    cells[c] = joined(all.subspan(count));
  }
  return taken;
}

double PdfDocument::row(double x_mm, double y_mm, const std::vector<double>& widths_mm,
                        const std::vector<std::string>& cells, bool is_heading) {
  const TextStyle style = cell_style(is_heading);
  double x = x_mm;
  for (std::size_t c = 0; c < cells.size() && c < widths_mm.size(); ++c) {
    paragraph(x + kCellPadMm, y_mm + line_height_mm(style), widths_mm[c] - 2 * kCellPadMm, cells[c], style);
    x += widths_mm[c];
  }
  y_mm += row_height_mm(widths_mm, cells, is_heading);
  line(x_mm, y_mm, x_mm + std::accumulate(widths_mm.begin(), widths_mm.end(), 0.0), y_mm,
       is_heading ? 0.35 : 0.12, is_heading ? kAccent : kGray);
  return y_mm;
}

double PdfDocument::table(double x_mm, double y_mm, const std::vector<double>& widths_mm,
                          const std::vector<std::vector<std::string>>& rows) {
  for (std::size_t r = 0; r < rows.size(); ++r) y_mm = row(x_mm, y_mm, widths_mm, rows[r], r == 0);
  return y_mm + 2;
}

void PdfDocument::save(const std::filesystem::path& file) { files::write_atomically(file, bytes()); }

std::string PdfDocument::bytes() {
  pdf_->check();
  HPDF_SaveToStream(pdf_->document);
  pdf_->check();
  std::string bytes(HPDF_GetStreamSize(pdf_->document), '\0');
  HPDF_ResetStream(pdf_->document);
  auto length = static_cast<HPDF_UINT32>(bytes.size());
  HPDF_ReadFromStream(pdf_->document, reinterpret_cast<HPDF_BYTE*>(bytes.data()), &length);
  pdf_->check();
  if (length != bytes.size()) throw IoError("the PDF writer gave less than the whole document");
  return with_text_map(std::move(bytes));
}

}  // namespace arthronaut::report
