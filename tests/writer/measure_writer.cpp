// Measures the writer on characters of a folder of hanzi-writer-data:
//   measure_writer sides DATA CHARACTERS                     features and measured sides of each stroke, a line each
//   measure_writer score DATA CHARACTERS [--fit 1] [--brush NAME] [--side MM] [--tries N] [--step UNITS] [--verbose 1]
//                                                          [--weak FOLDER] [--plain 1] [--drawn FOLDER] [--copied 1]
//   measure_writer copy DATA CHARACTERS                      strokes that are found again in a picture of the character
// CHARACTERS is a file. --weak writes a picture (.ppm) of each stroke below 0.92 (--below): wanted grey, missing red,
// extra blue, the path of the brush green. --plain takes the cue of the head off the centre lines: a first segment of
// less than 60 units, and the outlines, as sources without them (KanjiVG) are. --drawn writes each character as it is
// drawn (.pgm, a pixel a unit, for score_painted.py --drawn). --copied writes copies of pictures of the characters, and
// compares with these. `score` draws the writer's strokes on a plane, without
// texels, and compares their union with the outlines in cells of 2 units; score_painted.py compares what `tuft write`
// painted.
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <ctime>
#include <iostream>
#include <map>

#include "core/error.h"
#include "core/files/files.h"
#include "writer/copy/copied_glyph.h"
#include "writer/copy/photo.h"
#include "writer/fit/writer.h"
#include "writer/glyphs/glyph_source.h"

using namespace tuft;
using namespace tuft::writer;

namespace {

Glyph load(const std::string& folder, char32_t code) {
    const std::string path = folder + "/" + utf8_of(code) + ".json";
    const std::vector<char> bytes = read_file(path, 1 << 20);
    return parse_hanzi_json({bytes.data(), bytes.size()}, code, path);
}

void print_sides(const Glyph& glyph) {
    for (std::size_t i = 0; i < glyph.strokes.size(); ++i) {
        const StrokeLine line = make_stroke_line(glyph.strokes[i].median);
        std::string row = fmt::format("{} {}", utf8_of(glyph.code), line.stroke_class());
        for (const double f : stroke_features(line, glyph, i)) row += fmt::format(" {:.4g}", f);
        row += " |";
        for (const double s : row_of(measure_sides(line, glyph.strokes[i].outline))) row += fmt::format(" {:.4g}", s);
        std::cout << row << "\n";
    }
}

struct Overlap {
    double both = 0, either = 0;
    void add(bool a, bool b) { both += a && b, either += a || b; }
    double iou() const { return either > 0 ? both / either : 1; }
};

Cells square() {
    Cells cells{.lo = Vec2(-100), .cell = 2, .width = 612, .height = 612};
    cells.inside.assign(std::size_t(cells.width) * cells.height, 0);
    return cells;
}

constexpr int kPage = 1280, kPageMargin = 128;  // pixels, as in score_painted.py

/// Adds the ink of a stroke to a page of one unit a pixel.
void add_to_page(std::string& page, const stroke::PlaneInk& ink, double unit) {
    for (int j = 0; j < kPage; ++j)
        for (int i = 0; i < kPage; ++i)
            if (ink.at(unit * Vec2(i + 0.5 - kPageMargin, 1024 + kPageMargin - j - 0.5)) > 0.5)
                page[std::size_t(j) * kPage + i] = 0;
}

/// Writes the difference of a stroke's ink from its outline, and the path of the brush.
void write_weak(const std::string& path, const Cells& wanted, const Cells& drawn, const stroke::StrokeSamples& trace,
                double unit) {
    std::string ppm = fmt::format("P6\n{} {}\n255\n", wanted.width, wanted.height);
    const std::size_t head = ppm.size();
    for (int j = wanted.height - 1; j >= 0; --j)
        for (int i = 0; i < wanted.width; ++i) {
            const bool a = wanted.at(i, j), b = drawn.at(i, j);
            for (const int v :
                 {a ? 170 + 60 * !b : 255 - 175 * b, a ? 170 - 110 * !b : 255 - 135 * b, a ? 170 - 110 * !b : 255})
                ppm.push_back(static_cast<char>(v));
        }
    for (const stroke::StrokeSample& s : trace.samples) {
        const Vec2 p = (Vec2(s.position.x, -s.position.y) / unit - wanted.lo) / wanted.cell;
        const int i = static_cast<int>(p.x), j = wanted.height - 1 - static_cast<int>(p.y);
        if (i < 0 || j < 0 || i >= wanted.width || j >= wanted.height) continue;
        const std::size_t at = head + 3 * (std::size_t(j) * wanted.width + i);
        ppm[at] = 0, ppm[at + 1] = static_cast<char>(140), ppm[at + 2] = 0;
    }
    write_file(path, ppm.data(), ppm.size());
}

void take_cues_off(Glyph& glyph) {
    for (GlyphStroke& s : glyph.strokes) {
        const StrokeLine line = make_stroke_line(s.median);
        if (line.segments.size() < 2 || line.segments[0].length > 60) continue;
        s.median.assign(line.points.begin() + static_cast<std::ptrdiff_t>(line.segments[0].last), line.points.end());
    }
}

/// A picture of a character, a pixel a unit.
io::Image8 picture_of(const Glyph& glyph) {
    Cells cells{.lo = Vec2(-60), .cell = 1, .width = 1144, .height = 1144};
    cells.inside.assign(std::size_t(cells.width) * cells.height, 0);
    for (const GlyphStroke& s : glyph.strokes) fill(cells, s.outline);
    io::Image8 image{.width = cells.width, .height = cells.height, .channels = 1, .pixels = {}};
    for (int j = cells.height - 1; j >= 0; --j)
        for (int i = 0; i < cells.width; ++i) image.pixels.push_back(cells.at(i, j) ? 20 : 235);
    return image;
}

/// Points of a stroke's line at equal parts of its length.
std::vector<Vec2> parts_of_line(const std::vector<Vec2>& median) {
    const StrokeLine line = make_stroke_line(median);
    std::vector<Vec2> out;
    for (int k = 0; k <= 10; ++k) out.push_back(line.at(line.length() * k / 10));
    return out;
}

/// Prints how many strokes the copy of a picture has, how many of the character's are among them (the mean distance at
/// eleven places below 40 units, in the direction of writing), and how many pairs of these are in order.
void print_copies(const std::string& folder, const std::u32string& characters) {
    int right = 0, strokes = 0, found = 0, pairs = 0, ordered = 0;
    for (const char32_t code : characters) {
        const Glyph glyph = load(folder, code);
        const Cells ink = ink_of(picture_of(glyph), utf8_of(code));
        const Skeleton skeleton = skeleton_of(ink);
        Glyph copy = copied_glyph(ink, skeleton, order_by_rules(skeleton), code);
        Vec2 lo(1e300), hi(-1e300), own_lo(1e300), own_hi(-1e300);
        for (const GlyphStroke& s : glyph.strokes)
            for (const Ring& r : s.outline)
                for (const Vec2& p : r) lo = glm::min(lo, p), hi = glm::max(hi, p);
        for (const Ring& r : boundaries(ink, 0))
            for (const Vec2& p : r) own_lo = glm::min(own_lo, p), own_hi = glm::max(own_hi, p);
        for (GlyphStroke& s : copy.strokes)
            for (Vec2& p : s.median) p = lo + (p - own_lo) / (own_hi - own_lo) * (hi - lo);
        std::vector<int> at;
        for (const GlyphStroke& s : glyph.strokes) {
            const std::vector<Vec2> wanted = parts_of_line(s.median);
            int best = -1;
            double least = 40;
            for (std::size_t k = 0; k < copy.strokes.size(); ++k) {
                const std::vector<Vec2> line = parts_of_line(copy.strokes[k].median);
                double far = 0;
                for (std::size_t i = 0; i < line.size(); ++i) far += glm::distance(line[i], wanted[i]) / 11;
                if (far < least) least = far, best = static_cast<int>(k);
            }
            if (best >= 0) at.push_back(best);
        }
        strokes += static_cast<int>(glyph.strokes.size()), found += static_cast<int>(at.size());
        right += copy.strokes.size() == glyph.strokes.size();
        for (std::size_t a = 0; a < at.size(); ++a)
            for (std::size_t b = a + 1; b < at.size(); ++b) ++pairs, ordered += at[a] < at[b];
        fmt::print("{} {} of {} strokes, {} found\n", utf8_of(code), copy.strokes.size(), glyph.strokes.size(),
                   at.size());
    }
    fmt::print(
        "{} characters, {} with the right number of strokes; {:.3f} of {} strokes found, {:.3f} of {} pairs in order\n",
        characters.size(), right, double(found) / strokes, strokes, double(ordered) / pairs, pairs);
}

struct Sum {
    double iou = 0;
    int n = 0;
};

}  // namespace

int main(int argc, char** argv) {
    std::map<std::string, std::string> options;
    std::vector<std::string> words;
    for (int i = 1; i < argc; ++i)
        if (std::strncmp(argv[i], "--", 2) == 0 && i + 1 < argc)
            options[argv[i] + 2] = argv[i + 1], ++i;
        else
            words.emplace_back(argv[i]);
    const auto number = [&](const std::string& key, double otherwise) {
        return options.contains(key) ? std::stod(options[key]) : otherwise;
    };
    const std::vector<char> list = read_file(words.at(2));
    std::u32string characters;
    for (const char32_t c : characters_of({list.data(), list.size()}))
        if (c > 0x2000) characters.push_back(c);
    if (words.at(0) == "sides") {
        for (const char32_t code : characters) print_sides(load(words.at(1), code));
        return 0;
    }
    if (words.at(0) == "copy") {
        print_copies(words.at(1), characters);
        return 0;
    }
    WriterOptions with{.style = load_style("kaishu"), .side = number("side", 133) * 1e-3, .fit = number("fit", 0) > 0};
    if (options.contains("brush")) with.brush = options["brush"];
    with.style.tries = static_cast<int>(number("tries", with.style.tries));
    Writer writer(with);
    stroke::WidthTables tables;
    const BrushHand hand{tables.preset(writer.brush()), tables.of(writer.brush()), tables.holder(writer.brush()),
                         writer.unit()};
    std::map<std::string, Sum> classes;
    std::vector<double> scores;
    std::size_t n_strokes = 0;
    double seconds = 0;
    for (const char32_t code : characters) {
        Glyph glyph = load(words.at(1), code);
        if (options.contains("plain")) take_cues_off(glyph);
        if (options.contains("copied")) {
            const Cells ink = ink_of(picture_of(glyph), utf8_of(code));
            const Skeleton skeleton = skeleton_of(ink);
            glyph = copied_glyph(ink, skeleton, order_by_rules(skeleton), code);
        }
        Glyph given = glyph;
        if (options.contains("plain"))  // nor do such sources state outlines
            for (GlyphStroke& s : given.strokes) s.outline.clear();
        const std::clock_t start = std::clock();
        const std::vector<WrittenStroke> written = writer.write({given}).front();
        seconds += static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
        Cells truth = square(), drawn = square();
        std::string page(std::size_t(kPage) * kPage, static_cast<char>(255));
        for (std::size_t s = 0; s < written.size(); ++s) {
            fill(truth, glyph.strokes[s].outline);
            const stroke::PlaneInk ink = stroke::plane_ink(written[s].trace, hand.preset, hand.hold,
                                                           number("step", 5) * hand.unit, 2 * hand.unit);
            if (options.contains("drawn")) add_to_page(page, ink, hand.unit);
            Cells own = square();
            fill(own, glyph.strokes[s].outline);
            Overlap overlap;
            Cells ink_cells = square();
            for (int j = 0; j < own.height; ++j)
                for (int i = 0; i < own.width; ++i) {
                    const bool there = ink.at(own.centre(i, j) * hand.unit) > 0.5;
                    if (there) drawn.inside[std::size_t(j) * drawn.width + i] = 1;
                    if (there) ink_cells.inside[std::size_t(j) * drawn.width + i] = 1;
                    overlap.add(own.at(i, j), there);
                }
            Sum& sum = classes[make_stroke_line(glyph.strokes[s].median).stroke_class()];
            sum.iou += overlap.iou(), ++sum.n, ++n_strokes;
            if (options.contains("verbose")) fmt::print("  {} {:.3f}\n", written[s].label, overlap.iou());
            if (options.contains("weak") && overlap.iou() < number("below", 0.92))
                write_weak(fmt::format("{}/{:.3f}-{}-{}.ppm", options["weak"], overlap.iou(), utf8_of(code), s + 1),
                           own, ink_cells, written[s].trace, hand.unit);
        }
        if (options.contains("drawn")) {
            page.insert(0, fmt::format("P5\n{} {}\n255\n", kPage, kPage));
            write_file(options["drawn"] + "/" + utf8_of(code) + ".pgm", page.data(), page.size());
        }
        Overlap whole;
        for (std::size_t i = 0; i < truth.inside.size(); ++i) whole.add(truth.inside[i], drawn.inside[i]);
        scores.push_back(whole.iou());
        if (options.contains("verbose")) fmt::print("{} {:.3f}\n", utf8_of(code), scores.back());
    }
    std::vector<std::pair<std::string, Sum>> order(classes.begin(), classes.end());
    std::stable_sort(order.begin(), order.end(), [](auto& a, auto& b) { return a.second.n > b.second.n; });
    double all = 0, sum = 0;
    for (const auto& [name, s] : order) {
        if (s.n >= 5) fmt::print("{:6} {:4} strokes, mean {:.3f}\n", name, s.n, s.iou / s.n);
        all += s.iou;
    }
    for (const double s : scores) sum += s;
    fmt::print("{} characters: mean {:.4f}, worst {:.3f}; {} strokes: mean {:.4f}, {:.3f} s of CPU each\n",
               scores.size(), sum / static_cast<double>(scores.size()), *std::min_element(scores.begin(), scores.end()),
               n_strokes, all / static_cast<double>(n_strokes), seconds / static_cast<double>(n_strokes));
    return 0;
}
