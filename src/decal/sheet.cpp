#include "decal/sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "atlas/flatten/hull.h"
#include "atlas/seams/half_edges.h"
#include "core/error.h"
#include "core/system/parallel.h"
#include "decal/nest.h"
#include "decal/page_marks.h"
#include "decal/panels/gaps.h"

namespace tuft::decal {
namespace {

constexpr double kLevel = 0.3;          // tangential part of "up" below which a panel is level
constexpr double kBetween = 0.002;      // metres, least distance of two pieces' prints
constexpr double kLeastSide = 0.010;    // metres
constexpr double kHardlyMore = 1.2;     // of a page's height, that pieces may take to stand upright
constexpr double kStrainPixel = 5e-4;   // metres, of strain maps
constexpr double kFragment = 0.01;      // of the paint of the piece beyond the seam
constexpr double kSpeck = 0.1;          // of `least_fragment`
constexpr double kSliver = 0.1;         // of its film, that is painted
constexpr double kSpecksOfAll = 0.001;  // of all paint, all specks together, and all slivers
constexpr double kSeamStep = 1e-4;      // metres, at most, between the places of a seam that are looked at
constexpr double kBesideSeam = 2e-5;    // metres
constexpr double kTickFrom = 5e-4, kTickTo = 2.5e-3;  // metres from the film

/// Panels with what is printed round them.
struct CutFilm {
    FilmMesh film;
    std::vector<Panel> panels;
    std::map<std::uint32_t, std::size_t> index;  // of a panel, by its label
    std::vector<std::uint8_t> is_bare;           // [panels] nothing is painted there: it gets no piece

    std::uint32_t label(std::size_t panel) const { return film.label[panels[panel].chart.triangles[0]]; }
};

double printed_bleed(const SheetOptions& options) {
    return std::min(options.bleed, kPrintedBleed);
}

/// What is drawn beyond a piece's film: its printed bleed, and ticks of laps.
double drawn_around(const SheetOptions& options) {
    return std::max(printed_bleed(options), options.overlap > 0 ? kTickTo : 0);
}

/// How far film i reaches beyond its seam with another panel: the one with the lower number lies below. Beside a bare
/// one there is no seam.
double overlap_of(const CutFilm& cut, std::size_t i, std::uint32_t label, const SheetOptions& options) {
    const std::size_t other = cut.index.at(label);
    if (cut.is_bare[other]) return std::numeric_limits<double>::infinity();
    return other > i ? options.overlap : 0;
}

/// Up the model on a panel's sheet, unit; on level panels to its back.
Vec2 up_of(const atlas::ChartMesh& chart, const std::vector<Vec2>& flat) {
    Vec2 up = flat_direction(chart, flat, {0, 0, 1});
    if (glm::length(up) < kLevel) up = flat_direction(chart, flat, {0, 1, 0});
    const double length = glm::length(up);
    return length > 0 ? up / length : Vec2(0, 1);
}

/// The turn that brings `up` to the page's.
double upright_angle(const Vec2& up) {
    return 0.5 * std::numbers::pi - std::atan2(up.y, up.x);
}

/// Whether a panel with its bleed and its label fits the page in an orientation that it may take.
bool fits_page(const atlas::ChartMesh& chart, const std::vector<Vec2>& flat, const SheetOptions& options) {
    const Vec2 area = free_area(options.page);
    const double around = 2 * (options.bleed + drawn_around(options)) + kLabelHeight;
    Ring border;
    for (const std::uint32_t v : chart.loop) border.push_back(flat[v]);
    if (options.upright) {
        const double angle = upright_angle(up_of(chart, flat));
        const PagePlacement turn{std::cos(angle), std::sin(angle), Vec2(0)};
        for (Vec2& p : border) p = turn(p);
        const Vec2 size = box_of({border}).size() + Vec2(around);
        return size.x < area.x && (area.y == 0 || size.y < area.y);
    }
    const atlas::Rectangle box = atlas::smallest_rectangle(atlas::convex_hull(border));
    const double longest = area.y > 0 ? std::max(area.x, area.y) : std::numeric_limits<double>::infinity();
    const double shortest = area.y > 0 ? std::min(area.x, area.y) : area.x;
    return box.length + around < longest && box.width + around < shortest;
}

CutFilm cut_film(const mesh::TriangleMesh& model, const PrintSource& source, const SheetOptions& options) {
    CutFilm cut;
    cut.film = select_film(model, source.coverage, film_reach(options.bleed, options.join), source.texel);
    if (cut.film.source.empty()) throw Error("nothing is painted: there is no film to cut");
    PanelOptions panel_options{.max_strain = options.max_strain, .fits = {}, .progress = options.progress};
    panel_options.fits = [&](const atlas::ChartMesh& chart, const std::vector<Vec2>& flat) {
        return fits_page(chart, flat, options);
    };
    cut.panels = cut_into_panels(cut.film, source.coverage, panel_options);
    cut.is_bare.resize(cut.panels.size());
    parallel_for(cut.panels.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            cut.is_bare[i] = std::ranges::none_of(cut.panels[i].chart.triangles, [&](std::uint32_t t) {
                return is_painted(cut.film, t, source.coverage, source.texel);
            });
    });
    for (std::size_t i = 0; i < cut.panels.size(); ++i) cut.index[cut.label(i)] = i;
    return cut;
}

std::vector<Piece> find_pieces(const mesh::TriangleMesh& model, const CutFilm& cut, const PrintSource& source,
                               const SheetOptions& options, std::vector<PrintSurface>& surfaces) {
    std::vector<Piece> pieces;
    std::vector<std::uint8_t> in_gap;
    if (printed_bleed(options) > 0) in_gap = find_gaps(model, cut.film);
    for (std::size_t i = 0; i < cut.panels.size(); ++i) {
        report(options.progress, "cut lines", static_cast<double>(i) / static_cast<double>(cut.panels.size()));
        const auto reach = [&](std::uint32_t label) {
            const double overlap = overlap_of(cut, i, label, options);
            return (std::isinf(overlap) ? options.bleed : overlap) + printed_bleed(options);
        };
        surfaces.push_back(extend(cut.film, cut.panels[i], reach, in_gap, printed_bleed(options)));
        const OutlineOptions outline{
            .bleed = options.bleed,
            .join = options.join,
            .least_side = kLeastSide,
            .texel = source.texel,
            .overlap = [&](std::uint32_t label) { return overlap_of(cut, i, label, options); }};
        const Vec2 up = up_of(cut.panels[i].chart, cut.panels[i].flat);
        for (Outline& o : find_outlines(cut.film, cut.panels[i], surfaces[i], source.coverage, outline)) {
            Piece piece;
            piece.surface = i;
            piece.film = std::move(o.film);
            piece.paint_area = o.paint_area;
            piece.strain = cut.panels[i].strain;
            piece.up = up;
            pieces.push_back(std::move(piece));
        }
    }
    return pieces;
}

/// A panel's half-edge on its sheet; the panel lies on its left.
std::array<Vec2, 2> edge_of(const Panel& panel, std::size_t h) {
    return {panel.flat[panel.chart.faces[h / 3][h % 3]], panel.flat[panel.chart.faces[h / 3][(h % 3 + 1) % 3]]};
}

/// The point at part s of an edge, `kBesideSeam` to its left.
Vec2 beside(const std::array<Vec2, 2>& edge, double s) {
    const Vec2 along = edge[1] - edge[0];
    const double length = glm::length(along);
    return edge[0] + s * along + (length > 0 ? kBesideSeam / length : 0) * Vec2(-along.y, along.x);
}

/// The place at part s of a half-edge of the film: its triangle of the model, and the weights there.
std::pair<std::uint32_t, Weights> on_model(const FilmMesh& film, std::size_t half, double s) {
    const std::array<Weights, 3>& corners = film.weights[half / 3];
    Weights weights;
    for (std::size_t c = 0; c < 3; ++c) weights[c] = std::lerp(corners[half % 3][c], corners[(half + 1) % 3][c], s);
    return {film.source[half / 3], weights};
}

/// Whether a cut parts a piece from one of more than 1 / kFragment times its paint: paint goes over the seam.
bool continues_larger_piece(const CutFilm& cut, const std::vector<std::uint32_t>& twin, const Piece& piece,
                            const std::vector<Piece>& pieces, const CoverageFn& coverage) {
    const Panel& panel = cut.panels[piece.surface];
    const Box2 box = box_of(piece.film);
    for (std::size_t h = 0; h < panel.is_seam.size(); ++h) {
        if (!panel.is_seam[h]) continue;
        const std::array<Vec2, 2> edge = edge_of(panel, h);
        const Vec2 lo = glm::min(edge[0], edge[1]) - kBesideSeam, hi = glm::max(edge[0], edge[1]) + kBesideSeam;
        if (hi.x < box.lo.x || hi.y < box.lo.y || lo.x > box.hi.x || lo.y > box.hi.y) continue;
        const std::size_t half = 3 * std::size_t{panel.chart.triangles[h / 3]} + h % 3;
        const std::uint32_t across = twin[half];
        const std::size_t other = cut.index.at(cut.film.label[across / 3]);
        const std::vector<std::uint32_t>& triangles = cut.panels[other].chart.triangles;
        const auto at = std::lower_bound(triangles.begin(), triangles.end(), across / 3) - triangles.begin();
        const std::array<Vec2, 2> there = edge_of(cut.panels[other], 3 * static_cast<std::size_t>(at) + across % 3);
        const int n = static_cast<int>(glm::length(edge[1] - edge[0]) / kSeamStep) + 1;
        for (int i = 0; i < n; ++i) {
            const double s = (i + 0.5) / n;
            if (!contains(piece.film, beside(edge, s))) continue;
            if (const auto [triangle, weights] = on_model(cut.film, half, s); coverage(triangle, weights) < 0.5)
                continue;
            for (const Piece& p : pieces)
                if (p.surface == other && piece.paint_area < kFragment * p.paint_area &&
                    contains(p.film, beside(there, 1 - s)))
                    return true;
        }
    }
    return false;
}

/// Sum of the paint of the pieces that `is` true for.
double paint_where(const std::vector<Piece>& pieces, auto&& is) {
    double sum = 0;
    for (const Piece& piece : pieces)
        if (is(piece)) sum += piece.paint_area;
    return sum;
}

/// Takes fragments, specks and slivers out of the pieces.
LeftOut leave_out_fragments(const CutFilm& cut, const CoverageFn& coverage, const SheetOptions& options,
                            std::vector<Piece>& pieces) {
    const double least = options.least_fragment;
    const std::vector<std::uint32_t> twin = atlas::twin_half_edges(cut.film.mesh);
    const auto is_speck = [&](const Piece& piece) { return piece.paint_area < kSpeck * least; };
    const auto is_small_sliver = [&](const Piece& piece) { return is_sliver(piece, options.least_piece); };
    const double few = kSpecksOfAll * paint_where(pieces, [](const Piece&) { return true; });
    const bool no_specks = paint_where(pieces, is_speck) < few, no_slivers = paint_where(pieces, is_small_sliver) < few;
    std::vector<Piece> kept;
    LeftOut left_out;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        report(options.progress, "fragments", static_cast<double>(i) / static_cast<double>(pieces.size()));
        const Piece& piece = pieces[i];
        if ((no_specks && is_speck(piece)) || (no_slivers && is_small_sliver(piece)) ||
            (piece.paint_area < least && continues_larger_piece(cut, twin, piece, pieces, coverage))) {
            ++left_out.fragments;
            left_out.paint_area += piece.paint_area;
        } else {
            kept.push_back(piece);
        }
    }
    pieces = std::move(kept);
    return left_out;
}

/// What a piece takes up on a page in one orientation: its print and its label.
struct Footprint {
    double angle = 0;
    Ring shape;
    Vec2 label{0};  // lower left corner of the label's box
};

Footprint footprint_of(const Piece& piece, double angle, double around) {
    const PagePlacement turn{std::cos(angle), std::sin(angle), Vec2(0)};
    Region region = offset(piece.film, around);
    for (Ring& ring : region)
        for (Vec2& p : ring) p = turn(p);
    Vec2 top = region[0][0];
    for (const Ring& ring : region)
        for (const Vec2& p : ring)
            if (p.y > top.y) top = p;
    Footprint footprint{angle, {}, {}};
    const double width = label_width(piece.number);
    const Box2 box = box_of(region);
    const double left =
        std::clamp(top.x - 0.5 * width, std::min(box.lo.x, top.x), std::max(box.hi.x - width, top.x - width));
    footprint.label = {left, top.y};
    const Vec2 lo{left, top.y - 1e-4}, hi{left + width, top.y + kLabelHeight};
    region = unite(region, {{lo, {hi.x, lo.y}, hi, {lo.x, hi.y}}});
    footprint.shape = separate(region)[0][0];
    return footprint;
}

std::vector<Footprint> footprints_of(const Piece& piece, const SheetOptions& options, bool upright) {
    std::vector<double> angles;
    if (upright) {
        angles.push_back(upright_angle(piece.up));
    } else {
        const atlas::Rectangle box = atlas::smallest_rectangle(atlas::convex_hull(piece.film[0]));
        for (int k = 0; k < 4; ++k) angles.push_back(0.5 * std::numbers::pi * k - std::atan2(box.s, box.c));
    }
    std::vector<Footprint> all;
    all.reserve(angles.size());
    for (const double angle : angles) all.push_back(footprint_of(piece, angle, drawn_around(options)));
    return all;
}

/// All pieces on pages.
struct Layout {
    std::vector<std::vector<Footprint>> footprints;  // [n_pieces] in the orientations that a piece may take
    std::vector<NestPlace> places;                   // [n_pieces]
    std::size_t pages = 0;
    double used = 0;  // metres of the last page's height, or of a roll
    bool fits = true;

    bool takes_hardly_more_than(const Layout& other) const {
        if (!fits || !other.fits) return fits;
        return pages < other.pages || (pages == other.pages && used <= kHardlyMore * other.used);
    }
};

Layout lay_out(const std::vector<Piece>& pieces, const SheetOptions& options, bool upright) {
    Layout layout;
    std::vector<NestItem> items;
    for (const Piece& piece : pieces) {
        layout.footprints.push_back(footprints_of(piece, options, upright));
        items.emplace_back();
        for (const Footprint& f : layout.footprints.back()) items.back().shapes.push_back(f.shape);
    }
    layout.places = nest(items, free_area(options.page), kBetween);
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const NestPlace& place = layout.places[i];
        layout.fits &= place.fits;
        if (!place.fits) continue;
        layout.pages = std::max(layout.pages, place.page + 1);
    }
    for (std::size_t i = 0; i < pieces.size(); ++i)
        if (const NestPlace& place = layout.places[i]; place.fits && place.page + 1 == layout.pages)
            for (const Vec2& p : items[i].shapes[place.orientation])
                layout.used = std::max(layout.used, p.y + place.offset.y);
    return layout;
}

/// Places all pieces; returns where each one's label lies on its page.
std::vector<Vec2> place_pieces(std::vector<Piece>& pieces, const SheetOptions& options, std::vector<Page>& pages) {
    Layout layout = lay_out(pieces, options, options.upright);
    if (!options.upright)
        if (Layout upright = lay_out(pieces, options, true); upright.takes_hardly_more_than(layout))
            layout = std::move(upright);
    std::vector<Vec2> labels;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const NestPlace& place = layout.places[i];
        if (!place.fits) {
            const Vec2 size = 1000.0 * box_of({layout.footprints[i][0].shape}).size();
            throw Error(Message("piece {} of {} x {} mm fits no page; choose a larger one, or let pieces be turned",
                                pieces[i].number, std::lround(size.x), std::lround(size.y)));
        }
        const Footprint& f = layout.footprints[i][place.orientation];
        const Vec2 offset = place.offset + free_origin();
        pieces[i].page = place.page;
        pieces[i].placement = {std::cos(f.angle), std::sin(f.angle), offset};
        labels.push_back(f.label + offset);
    }
    pages.assign(layout.pages, {.size = options.page});
    if (options.page.y == 0)
        for (Page& page : pages) page.size.y = roll_length(layout.used + free_origin().y);
    return labels;
}

/// Ticks beside a piece, at both ends of the line up to which the next one reaches. They stand on the waste: whatever
/// is drawn on the film is printed, on every plate.
void add_lap_ticks(const CutFilm& cut, const Piece& piece, const SheetOptions& options, Page& page) {
    const Panel& panel = cut.panels[piece.surface];
    const std::vector<std::uint32_t> twin = atlas::twin_half_edges(cut.film.mesh);
    for (std::uint32_t h = 0; h < panel.is_seam.size(); ++h) {
        if (!panel.is_seam[h]) continue;
        const std::uint32_t label = cut.film.label[twin[3 * panel.chart.triangles[h / 3] + h % 3] / 3];
        if (cut.index.at(label) <= piece.surface || options.overlap <= 0 || cut.is_bare[cut.index.at(label)]) continue;
        const auto [a, b] = edge_of(panel, h);
        const double length = glm::length(b - a);
        const int n = static_cast<int>(length / kSeamStep) + 1;
        bool inside = contains(piece.film, a);
        for (int i = 1; i <= n; ++i) {
            const Vec2 p = glm::mix(a, b, static_cast<double>(i) / n);
            if (contains(piece.film, p) == inside) continue;
            const Vec2 out = (inside ? 1.0 : -1.0) * (b - a) / length;
            inside = !inside;
            // A concave border may meet its own film again.
            double to = 0;
            while (to < kTickTo && !contains(piece.film, p + (to + kTickFrom) * out)) to += kSeamStep;
            to = std::min(to, kTickTo);
            if (to < 2 * kTickFrom) continue;
            page.lines.push_back(
                {{piece.placement(p + kTickFrom * out), piece.placement(p + to * out)}, false, Role::label});
        }
    }
}

/// The number of an ink among those of the sheet, with which its colour is averaged.
std::size_t add_ink(const PrintedInk& printed, std::vector<PrintedInk>& inks) {
    const auto same = std::ranges::find_if(inks, [&](const PrintedInk& i) { return is_same_mix(i.mix, printed.mix); });
    if (same == inks.end()) {
        inks.push_back(printed);
        return inks.size() - 1;
    }
    const double part = printed.weight / (same->weight + printed.weight);
    for (std::size_t c = 0; c < 3; ++c) same->colour[c] = std::lerp(same->colour[c], printed.colour[c], part);
    same->weight += printed.weight;
    return static_cast<std::size_t>(same - inks.begin());
}

/// Draws the paint of a piece onto its page.
void draw_paint(const PrintSource& source, const SheetOptions& options, Piece& piece, const PrintSurface& surface,
                Page& page, std::vector<PrintedInk>& inks) {
    const double bleed = printed_bleed(options);
    const auto add_area = [&](std::size_t ink, const CoverageFn& coverage) {
        Region region = find_ink_area(surface, coverage, piece.film, bleed, source.texel);
        piece.outlined = true;
        if (!region.empty()) page.areas.push_back({ink, placed(region, piece.placement)});
    };
    if (options.outlines && !source.plates.empty()) {
        for (std::size_t m = 0; m < source.plates.size(); ++m) add_area(m, source.plates[m]);
        return;
    }
    PrintSource picture = source;
    if (options.outlines && source.amounts) {
        if (const auto ink = find_single_ink(sample_paint(surface, source, piece.film)))
            return add_area(add_ink(*ink, inks), source.coverage);
        picture.amounts = nullptr;
    }
    if (options.prints)
        page.prints.push_back(print_piece(surface, picture, piece.placement, piece.film, bleed, options.pixel));
}

void draw_pieces(const CutFilm& cut, const PrintSource& source, const SheetOptions& options,
                 const std::vector<Vec2>& labels, Sheet& sheet) {
    const std::size_t n = sheet.pages.size();
    if (options.strain_map)
        for (std::size_t i = 0; i < n; ++i) {
            sheet.pages.push_back({.size = sheet.pages[i].size});
            sheet.pages.back().strain_map = true;
        }
    std::vector<PrintedInk> inks;
    for (std::size_t i = 0; i < sheet.pieces.size(); ++i) {
        report(options.progress, "prints", static_cast<double>(i) / static_cast<double>(sheet.pieces.size()));
        Piece& piece = sheet.pieces[i];
        const PrintSurface& surface = sheet.surfaces[piece.surface];
        Page& page = sheet.pages[piece.page];
        draw_paint(source, options, piece, surface, page, inks);
        for (const Ring& ring : placed(piece.film, piece.placement)) page.lines.push_back({ring, true, Role::cut});
        add_lap_ticks(cut, piece, options, page);
        const Vec2 up{piece.placement.c * piece.up.x - piece.placement.s * piece.up.y,
                      piece.placement.s * piece.up.x + piece.placement.c * piece.up.y};
        add_label(page, piece.number, labels[i], up);
        if (!options.strain_map) continue;
        Page& map = sheet.pages[n + piece.page];
        map.prints.push_back(print_strain(surface, piece.placement, piece.film, kStrainPixel, options.max_strain));
        for (const Ring& ring : placed(piece.film, piece.placement)) map.lines.push_back({ring, true, Role::label});
        add_label(map, piece.number, labels[i], up);
    }
    for (PrintedInk& ink : inks) sheet.inks.push_back({.name = {}, .colour = ink.colour, .mix = std::move(ink.mix)});
    for (std::size_t i = 0; i < sheet.pages.size(); ++i) {
        FootText text{.title = options.title, .page = i % n + 1, .pages = n, .limit = options.max_strain};
        for (const Piece& piece : sheet.pieces)
            if (piece.page == i % n) text.strain = std::max(text.strain, piece.strain);
        add_marks(sheet.pages[i], text);
    }
}

}  // namespace

bool is_sliver(const Piece& piece, double least) {
    return piece.paint_area < least && piece.paint_area < kSliver * area_of(piece.film);
}

Sheet make_sheet(const mesh::TriangleMesh& model, const PrintSource& source, const SheetOptions& options) {
    const CutFilm cut = cut_film(model, source, options);
    Sheet sheet;
    sheet.max_strain = options.max_strain;
    sheet.pieces = find_pieces(model, cut, source, options, sheet.surfaces);
    if (sheet.pieces.empty()) throw Error("nothing is painted: there is no film to cut");
    sheet.left_out = leave_out_fragments(cut, source.coverage, options, sheet.pieces);
    for (std::size_t i = 0; i < sheet.pieces.size(); ++i) sheet.pieces[i].number = static_cast<int>(i) + 1;
    const std::vector<Vec2> labels = place_pieces(sheet.pieces, options, sheet.pages);
    draw_pieces(cut, source, options, labels, sheet);
    return sheet;
}

}  // namespace tuft::decal
