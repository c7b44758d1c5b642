#include "io/sheet/sheet_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <set>

#include "core/error.h"
#include "core/files/extension.h"
#include "core/files/files.h"
#include "core/files/text_file.h"
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

/// Numbers names that differ in capitals alone, or not at all: DXF and files of layers know no capitals.
void tell_apart(std::vector<std::string>& names, std::size_t longest) {
    std::set<std::string> used;
    const auto is_new = [&](std::string name) {
        for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        return used.insert(name).second;
    };
    for (std::string& name : names) {
        const std::string plain = name;
        for (int k = 2; !is_new(name); ++k) {
            const std::string number = fmt::format("_{}", k);
            name = plain.substr(0, std::min(plain.size(), longest - number.size())) + number;
        }
    }
}

}  // namespace

std::vector<std::string> ink_layers(const decal::Sheet& sheet) {
    std::vector<std::string> names;
    for (const decal::SheetInk& ink : sheet.inks) {
        std::string& name = names.emplace_back("Ink " + ink.name);
        for (char& c : name)
            if (static_cast<unsigned char>(c) < ' ' || c == '\x7f' || std::strchr("<>/\\\":;?*|='", c)) c = '_';
    }
    tell_apart(names, std::string::npos);
    return names;
}

std::vector<std::string> dxf_ink_layers(const decal::Sheet& sheet) {
    constexpr std::size_t kLongest = 31;
    std::vector<std::string> names;
    for (const decal::SheetInk& ink : sheet.inks) {
        std::string& name = names.emplace_back("Ink_");
        for (const char c : ink.name) {
            const auto byte = static_cast<unsigned char>(c);
            if ((byte & 0xc0) == 0x80) continue;  // of a character of UTF-8 that is an '_' already
            name += byte < 0x80 && (std::isalnum(byte) || c == '$' || c == '-') ? c : '_';
        }
        name.resize(std::min(name.size(), kLongest));
    }
    tell_apart(names, kLongest);
    return names;
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
