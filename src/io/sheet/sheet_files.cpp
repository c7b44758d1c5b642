#include "io/sheet/sheet_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstring>

#include "core/error.h"
#include "core/files/extension.h"
#include "core/files/files.h"
#include "io/export/export.h"

namespace fs = std::filesystem;

namespace tuft::io {
namespace {

fs::path numbered(const fs::path& path, std::size_t number, std::size_t count) {
    if (count == 1) return path;
    return path.parent_path() / fmt::format("{}-{}{}", path.stem().string(), number, path.extension().string());
}

bool has_plate_pictures(const decal::Sheet& sheet) {
    return std::ranges::any_of(sheet.pages, [](const decal::Page& page) {
        return std::ranges::any_of(page.prints, [](const decal::PrintImage& image) { return !image.plates.empty(); });
    });
}

void write_text(const fs::path& path, const std::string& text) {
    write_file(path, text.data(), text.size());
}

}  // namespace

std::string ink_layer(const std::string& ink) {
    std::string name = "Ink " + ink;
    for (char& c : name)
        if (static_cast<unsigned char>(c) < ' ' || c == '\x7f' || std::strchr("<>/\\\":;?*|='", c)) c = '_';
    return name;
}

std::vector<fs::path> write_sheet(const fs::path& path, const decal::Sheet& sheet) {
    const std::string extension = lower_extension(path);
    if (extension == ".pdf") {
        write_text(path, pdf_bytes(sheet));
        return {path};
    }
    if (extension != ".svg" && extension != ".dxf")
        throw Error(path.string(), "a sheet is written as .pdf, .svg or .dxf");
    if (extension == ".svg" && has_plate_pictures(sheet))
        throw Error(path.string(), "plates are separations, which only a .pdf has");
    std::vector<std::size_t> pages;
    for (std::size_t i = 0; i < sheet.pages.size(); ++i)
        if (extension == ".svg" || !sheet.pages[i].strain_map) pages.push_back(i);
    std::vector<fs::path> files;
    write_together(path, [&](const fs::path& folder) {
        for (std::size_t i = 0; i < pages.size(); ++i) {
            const fs::path file = numbered(path, i + 1, pages.size());
            write_text(folder / file.filename(),
                       extension == ".svg" ? svg_text(sheet, pages[i]) : dxf_text(sheet, pages[i]));
            files.push_back(file);
        }
    });
    return files;
}

}  // namespace tuft::io
