#include "app/report/pdf_document.h"

#include <hpdf.h>

#include <algorithm>
#include <array>

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

  explicit Pdf(const std::string& title) {
    document = HPDF_New(remember, &failure);
    if (document == nullptr) throw IoError("the PDF writer could not be started");
    HPDF_UseUTFEncodings(document);
    HPDF_SetCompressionMode(document, HPDF_COMP_ALL);
    regular = load(kRegularFont);
    bold = load(kBoldFont);
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
  void use(const TextStyle& style) const {
    HPDF_Page_SetFontAndSize(page, style.bold ? bold : regular, static_cast<HPDF_REAL>(style.size_pt));
    HPDF_Page_SetRGBFill(page, static_cast<HPDF_REAL>(style.ink.red), static_cast<HPDF_REAL>(style.ink.green),
                         static_cast<HPDF_REAL>(style.ink.blue));
  }
};

namespace {

HPDF_REAL points(double mm) { return static_cast<HPDF_REAL>(mm * kPointsPerMm); }
HPDF_REAL from_top(double mm) { return static_cast<HPDF_REAL>((PdfDocument::kHeightMm - mm) * kPointsPerMm); }

double line_height_mm(const TextStyle& style) { return 1.35 * style.size_pt / kPointsPerMm; }

}  // namespace

PdfDocument::PdfDocument(const std::string& title) : pdf_(std::make_unique<Pdf>(title)) {}
PdfDocument::~PdfDocument() = default;

void PdfDocument::add_page() {
  pdf_->page = HPDF_AddPage(pdf_->document);
  pdf_->check();
  HPDF_Page_SetSize(pdf_->page, HPDF_PAGE_SIZE_A4, HPDF_PAGE_PORTRAIT);
}

void PdfDocument::text(double x_mm, double y_mm, std::string_view text, const TextStyle& style) {
  pdf_->use(style);
  HPDF_Page_BeginText(pdf_->page);
  HPDF_Page_TextOut(pdf_->page, points(x_mm), from_top(y_mm), std::string(text).c_str());
  HPDF_Page_EndText(pdf_->page);
  pdf_->check();
}

double PdfDocument::text_width_mm(std::string_view text, const TextStyle& style) {
  pdf_->use(style);
  return HPDF_Page_TextWidth(pdf_->page, std::string(text).c_str()) / kPointsPerMm;
}

double PdfDocument::paragraph(double x_mm, double y_mm, double width_mm, std::string_view text,
                              const TextStyle& style) {
  std::string line;
  const auto flush = [&] {
    if (!line.empty()) this->text(x_mm, y_mm, line, style);
    y_mm += line_height_mm(style);
    line.clear();
  };
  while (!text.empty()) {
    const auto space = text.find(' ');
    const std::string word(text.substr(0, space));
    text.remove_prefix(space == std::string_view::npos ? text.size() : space + 1);
    const std::string longer = line.empty() ? word : line + " " + word;
    if (!line.empty() && text_width_mm(longer, style) > width_mm) {
      flush();
      line = word;
    } else {
      line = longer;
    }
  }
  flush();
  return y_mm;
}

void PdfDocument::line(double x0_mm, double y0_mm, double x1_mm, double y1_mm, double width_mm,
                       const Ink& ink) {
  HPDF_Page_SetRGBStroke(pdf_->page, static_cast<HPDF_REAL>(ink.red), static_cast<HPDF_REAL>(ink.green),
                         static_cast<HPDF_REAL>(ink.blue));
  HPDF_Page_SetLineWidth(pdf_->page, points(width_mm));
  HPDF_Page_MoveTo(pdf_->page, points(x0_mm), from_top(y0_mm));
  HPDF_Page_LineTo(pdf_->page, points(x1_mm), from_top(y1_mm));
  HPDF_Page_Stroke(pdf_->page);
  pdf_->check();
}

void PdfDocument::filled_rectangle(double x_mm, double y_mm, double width_mm, double height_mm,
                                   const Ink& ink) {
  HPDF_Page_SetRGBFill(pdf_->page, static_cast<HPDF_REAL>(ink.red), static_cast<HPDF_REAL>(ink.green),
                       static_cast<HPDF_REAL>(ink.blue));
  HPDF_Page_Rectangle(pdf_->page, points(x_mm), from_top(y_mm + height_mm), points(width_mm),
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
  HPDF_Page_DrawImage(pdf_->page, image, points(x_mm), from_top(y_mm + height_mm), points(width_mm),
                      points(height_mm));
  pdf_->check();
  return height_mm;
}

double PdfDocument::table(double x_mm, double y_mm, const std::vector<double>& widths_mm,
                          const std::vector<std::vector<std::string>>& rows) {
  constexpr double kPadMm = 1.5, kBottomMm = 280, kTopMm = 25;
  double total_mm = 0;
  for (const double w : widths_mm) total_mm += w;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const TextStyle style{.size_pt = 8.8, .bold = r == 0, .ink = r == 0 ? kAccent : kBlack};
    if (y_mm > kBottomMm) {
      add_page();
      y_mm = kTopMm;
    }
    double x = x_mm, bottom = y_mm + line_height_mm(style);
    for (std::size_t c = 0; c < rows[r].size() && c < widths_mm.size(); ++c) {
      const double below =
          paragraph(x + kPadMm, y_mm + line_height_mm(style), widths_mm[c] - 2 * kPadMm, rows[r][c], style);
      bottom = std::max(bottom, below);
      x += widths_mm[c];
    }
    y_mm = bottom - 0.4 * line_height_mm(style) + kPadMm / 2;
    line(x_mm, y_mm, x_mm + total_mm, y_mm, r == 0 ? 0.35 : 0.12, r == 0 ? kAccent : kGray);
  }
  return y_mm + 2;
}

void PdfDocument::save(const std::filesystem::path& file) {
  pdf_->check();
  files::write_atomically(file, [this](const std::filesystem::path& temporary) {
    HPDF_SaveToFile(pdf_->document, temporary.c_str());
    if (pdf_->failure.status != HPDF_OK)
      throw IoError(temporary, "cannot write the PDF (disk full or read-only?)");
  });
}

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
  return bytes;
}

}  // namespace arthronaut::report
