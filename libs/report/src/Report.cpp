// SPDX-License-Identifier: BSD-3-Clause
// Writes what a run leaves behind.
#include <csom/core/Error.h>
#include <csom/io/OutputFile.h>
#include <csom/report/HtmlReport.h>
#include <csom/report/Report.h>

#include <filesystem>
#include <system_error>

namespace csom {

namespace {

void writeFile(const std::filesystem::path& path, const void* bytes, std::size_t size) {
  OutputFile file(path.string());
  file.write(bytes, size);
  file.commit();
}

}  // namespace

void writeReport(const RunRecord& record, const MapDocument& document, const MapFigures& figures,
                 const std::string& folder, const ReportOptions& options) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw FileError(folder, "cannot create this folder: " + error.message());

  const std::filesystem::path base(folder);
  if (options.json) {
    const std::string json = toJson(record, figures);
    writeFile(base / "run.json", json.data(), json.size());
  }
  if (!options.png && !options.html) return;

  TopViewOptions view = options.top_view;
  view.up = record.up;
  const std::vector<std::uint8_t> top_view = topViewPng(document, view);
  if (options.png) writeFile(base / "top.png", top_view.data(), top_view.size());
  if (options.html) {
    const std::string page = htmlReport(record, figures, top_view);
    writeFile(base / "report.html", page.data(), page.size());
  }
}

}  // namespace csom
