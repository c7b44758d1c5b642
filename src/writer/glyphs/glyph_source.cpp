#include "writer/glyphs/glyph_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <map>
#include <set>

#include "core/error.h"
#include "core/files/files.h"
#include "core/files/path_fault.h"
#include "core/files/text_file.h"
#include "io/font/font.h"
#include "io/font/installed_fonts.h"
#include "writer/glyphs/outline_font.h"

namespace fs = std::filesystem;

namespace tuft::writer {
namespace {

constexpr std::size_t kMostGlyphBytes = std::size_t{1} << 20, kMostBookBytes = std::size_t{512} << 20;

/// A file of each character.
class Folder : public GlyphSource {
  public:
    explicit Folder(fs::path path) : path_(std::move(path)) {}

    std::optional<Glyph> find(char32_t code) override {
        std::error_code none;
        if (const fs::path json = path_ / (utf8_of(code) + ".json");
            code > 0x20 && code != '/' && fs::exists(json, none))
            return parse_hanzi_json(read_text(json, kMostGlyphBytes), code, json.string());
        if (const fs::path svg = path_ / fmt::format("{:05x}.svg", static_cast<unsigned>(code)); fs::exists(svg, none))
            return parse_kanji_svg(read_text(svg, kMostGlyphBytes), code, svg.string());
        return std::nullopt;
    }

  private:
    fs::path path_;
};

/// `graphics.txt`: a JSON object a line. Lines are parsed when they are asked for.
class Book : public GlyphSource {
  public:
    explicit Book(const fs::path& path) : name_(path.string()), text_(read_text(path, kMostBookBytes)) {
        static constexpr std::string_view kKey = "\"character\":\"";
        for (std::size_t begin = 0, number = 1; begin < text_.size(); ++number) {
            const std::size_t end = std::min(text_.find('\n', begin), text_.size());
            const std::string_view line(text_.data() + begin, end - begin);
            if (const std::size_t key = line.find(kKey); key != std::string_view::npos) {
                const std::string_view rest = line.substr(key + kKey.size(), 4 * 4);
                const std::u32string character = characters_of(rest.substr(0, rest.find('"')));
                if (character.size() == 1) lines_[character[0]] = {begin, end - begin, number};
            }
            begin = end + 1;
        }
        if (lines_.empty()) throw Error(name_, Message("it has no line with a \"character\""));
    }

    std::optional<Glyph> find(char32_t code) override {
        const auto at = lines_.find(code);
        if (at == lines_.end()) return std::nullopt;
        const Line& line = at->second;
        return parse_hanzi_json(std::string_view(text_).substr(line.begin, line.size), code,
                                fmt::format("{}:{}", name_, line.number));
    }

  private:
    struct Line {
        std::size_t begin = 0, size = 0, number = 0;
    };
    std::string name_, text_;
    std::map<char32_t, Line> lines_;
};

class LineFont : public GlyphSource {
  public:
    explicit LineFont(const fs::path& path) {
        LineFontGlyphs font = parse_line_font(read_text(path, kMostBookBytes), path.string());
        for (Glyph& g : font.glyphs) glyphs_.emplace(g.code, std::move(g));
        kerning_ = std::move(font.kerning);
    }
    std::optional<Glyph> find(char32_t code) override {
        const auto at = glyphs_.find(code);
        return at == glyphs_.end() ? std::nullopt : std::optional(at->second);
    }
    double kerning(char32_t first, char32_t second) override {
        const auto at = kerning_.find({first, second});
        return at == kerning_.end() ? 0 : at->second;
    }

  private:
    std::map<char32_t, Glyph> glyphs_;
    std::map<std::pair<char32_t, char32_t>, double> kerning_;
};

/// The first of several that has a character.
class Sources : public GlyphSource {
  public:
    explicit Sources(std::vector<std::unique_ptr<GlyphSource>> all) : all_(std::move(all)) {}
    std::optional<Glyph> find(char32_t code) override {
        for (const auto& one : all_)
            if (std::optional<Glyph> glyph = one->find(code)) return glyph;
        return std::nullopt;
    }
    double kerning(char32_t first, char32_t second) override {
        for (const auto& one : all_)
            if (const double k = one->kerning(first, second); k != 0) return k;
        return 0;
    }

  private:
    std::vector<std::unique_ptr<GlyphSource>> all_;
};

std::unique_ptr<GlyphSource> open_folder(const fs::path& path) {
    std::vector<fs::path> books, fonts, outlines;
    bool characters = false;
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(path, error)) {
        const fs::path& file = entry.path();
        const std::string kind = file.extension().string();
        if (kind == ".txt") books.push_back(file);
        if (io::is_font_file(file)) outlines.push_back(file);
        if (kind == ".json") characters = true;
        if (kind != ".svg") continue;
        const std::string stem = file.stem().string();
        const std::string code = stem.substr(0, stem.find('-'));
        if (code.size() != 5 || code.find_first_not_of("0123456789abcdef") != std::string::npos)
            fonts.push_back(file);
        else if (code == stem)  // beside it KanjiVG has other forms of a character, such as 04e14-Kaisho.svg
            characters = true;
    }
    if (error) throw Error(path.string(), Message("the folder cannot be read"));
    for (auto* list : {&books, &fonts, &outlines}) std::sort(list->begin(), list->end());
    std::vector<std::unique_ptr<GlyphSource>> all;
    if (characters) all.push_back(std::make_unique<Folder>(path));
    for (const fs::path& p : books) all.push_back(std::make_unique<Book>(p));
    for (const fs::path& p : fonts) all.push_back(std::make_unique<LineFont>(p));
    for (const fs::path& p : outlines) all.push_back(open_outline_font(p));
    if (all.empty())
        throw Error(path.string(),
                    Message("no characters are found: neither CHARACTER.json, CODE.svg, graphics.txt nor a font"));
    return std::make_unique<Sources>(std::move(all));
}

/// The font of a family's name. None for what looks like a path, and for generic names as "serif", which any font
/// answers.
io::InstalledFont installed_font(const std::string& name) {
    constexpr std::size_t kLongestName = 128;
    if (name.size() > kLongestName || name.find('/') != std::string::npos || fs::path(name).has_extension()) return {};
    io::InstalledFont font = io::find_font({.families = {name}});
    return font.requested && font.family == name ? font : io::InstalledFont{};
}

constexpr double kThinSpace = 0.2, kSpace = 0.35;  // parts of the side

bool is_blank(char32_t c) {
    return c == ' ' || c == '\t' || c == 0xA0 || (c >= 0x2000 && c <= 0x200A) || c == 0x202F || c == 0x205F ||
           c == 0x3000;
}

Glyph blank(char32_t c) {
    const bool wide = c == 0x3000 || c == 0x2001 || c == 0x2003;
    const bool thin = c == 0x202F || c == 0x2009 || c == 0x200A;
    return {.code = c, .advance = (wide ? 1 : thin ? kThinSpace : kSpace) * kSide};
}

/// A full-width form (U+FF01 to U+FF5E) from the character that it is a form of, in the middle of a square.
std::optional<Glyph> full_width(char32_t code, const std::vector<GlyphSource*>& sources) {
    if (code < 0xFF01 || code > 0xFF5E) return std::nullopt;
    for (GlyphSource* source : sources)
        if (std::optional<Glyph> glyph = source->find(code - 0xFEE0)) {
            const Vec2 shift(0.5 * (kSide - glyph->advance), 0);
            map_points(*glyph, [&](const Vec2& p) { return p + shift; });
            glyph->code = code;
            glyph->advance = kSide;
            return glyph;
        }
    return std::nullopt;
}

}  // namespace

std::vector<std::optional<Glyph>> GlyphSource::find_line(const std::u32string& line) {
    std::vector<std::optional<Glyph>> out;
    for (const char32_t c : line) out.push_back(is_blank(c) ? blank(c) : find(c));
    for (std::size_t i = 0; i + 1 < line.size(); ++i)
        if (out[i] && out[i + 1]) out[i]->advance = std::max(0.0, out[i]->advance - kerning(line[i], line[i + 1]));
    return out;
}

std::unique_ptr<GlyphSource> open_glyphs(const fs::path& path) {
    std::error_code error;
    if (!fs::exists(path, error) && error && error.value() != ENOENT) check_exists(path);
    if (!fs::exists(path, error)) {
        if (const io::InstalledFont font = installed_font(path.string()); font.requested)
            return open_outline_font(font.file, font.face);
        throw Error(path.string(), Message("there is no such file or folder of characters, nor an installed font"));
    }
    if (fs::is_directory(path, error)) return open_folder(path);
    if (path.extension() == ".svg") return std::make_unique<LineFont>(path);
    if (io::is_font_file(path)) return open_outline_font(path);
    if (path.extension() == ".txt" || path.extension() == ".json" || path.extension() == ".jsonl")
        return std::make_unique<Book>(path);
    throw Error(path.string(), Message("neither a folder of characters, graphics.txt, an SVG font nor a font"));
}

fs::path bundled_glyphs() {
    return data_folder() / "models" / "glyphs";
}

std::vector<std::vector<Glyph>> glyphs_of(const std::vector<std::u32string>& lines,
                                          const std::vector<GlyphSource*>& sources) {
    std::vector<std::vector<Glyph>> out;
    std::set<char32_t> missing;
    for (const std::u32string& line : lines) {
        std::vector<std::optional<Glyph>> found(line.size());
        for (GlyphSource* source : sources) {
            const bool none = std::none_of(found.begin(), found.end(), [](const auto& g) { return g.has_value(); });
            if (none) {
                found = source->find_line(line);
                continue;
            }
            for (std::size_t i = 0; i < line.size() && found.size() == line.size(); ++i)
                if (!found[i]) found[i] = source->find(line[i]);
        }
        for (std::size_t i = 0; i < line.size() && found.size() == line.size(); ++i)
            if (!found[i]) found[i] = full_width(line[i], sources);
        std::vector<Glyph>& row = out.emplace_back();
        for (std::size_t i = 0; i < found.size(); ++i)
            if (found[i])
                row.push_back(std::move(*found[i]));
            else
                missing.insert(line[std::min(i, line.size() - 1)]);
    }
    if (missing.empty()) return out;
    std::string names;
    for (const char32_t c : missing) names += (names.empty() ? "" : " ") + utf8_of(c);
    throw Error(Message("no source has the characters {}", names));
}

}  // namespace tuft::writer
