#include "app/report/pdf_text_map.h"

#include <charconv>
#include <vector>

#include "planning/files/format.h"
#include "planning/geometry/error.h"

namespace arthronaut::report {

namespace {

[[noreturn]] void refuse(const char* what) {
  throw IoError(std::string("the PDF writer's document has no ") + what);
}

// The number that stands behind `words`, from `from` on; where it ends is put into `from`.
long number_behind(const std::string& pdf, const std::string& words, std::size_t& from) {
  const std::size_t at = pdf.find(words, from);
  if (at == std::string::npos) refuse(words.c_str());
  const char* begin = pdf.data() + at + words.size();
  long number = 0;
  const auto [end, error] = std::from_chars(begin, pdf.data() + pdf.size(), number);
  if (error != std::errc()) refuse(words.c_str());
  from = static_cast<std::size_t>(end - pdf.data());
  return number;
}

// libharu's codes are UTF-16. A range may not run over its last byte, and a block holds 100 ranges.
std::string unicode_map() {
  std::string map =
      "/CIDInit /ProcSet findresource begin\n12 dict begin\nbegincmap\n/CMapName /Arthronaut-UCS2 def\n"
      "/CMapType 2 def\n1 begincodespacerange\n<0000> <FFFF>\nendcodespacerange\n";
  constexpr int kRanges = 256, kOfBlock = 64;
  for (int high = 0; high < kRanges; ++high) {
    if (high % kOfBlock == 0) map += files::format("%d beginbfrange\n", kOfBlock);
    map += files::format("<%02X00> <%02XFF> <%02X00>\n", high, high, high);
    if ((high + 1) % kOfBlock == 0) map += "endbfrange\n";
  }
  return map + "endcmap\nCMapName currentdict /CMap defineresource pop\nend\nend\n";
}

}  // namespace

std::string with_text_map(std::string pdf) {
  const std::string to_map = "/ToUnicode ";
  std::vector<long> objects;
  for (std::size_t at = 0; (at = pdf.find(to_map, at)) != std::string::npos;)
    objects.push_back(number_behind(pdf, to_map, at));
  if (objects.empty()) return pdf;  // no text
  std::size_t trailer = pdf.rfind("trailer");
  if (trailer == std::string::npos) refuse("trailer");
  const std::size_t end = pdf.find(">>", trailer);
  if (end == std::string::npos) refuse("trailer");
  const std::string entries = pdf.substr(trailer, end - trailer);
  const long previous = number_behind(pdf, "startxref\n", trailer);

  const std::string map = unicode_map();
  std::string table;
  for (const long object : objects) {
    table += files::format("%ld 1\n%010zu 00000 n \n", object, pdf.size());
    pdf += files::format("%ld 0 obj\n<<\n/Length %zu\n>>\nstream\n", object, map.size()) + map +
           "\nendstream\nendobj\n";
  }
  const std::size_t start = pdf.size();
  return pdf + "xref\n" + table + entries +
         files::format("/Prev %ld\n>>\nstartxref\n%zu\n%%%%EOF\n", previous, start);
}

}  // namespace arthronaut::report
