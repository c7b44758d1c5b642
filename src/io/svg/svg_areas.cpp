#include "io/svg/svg_areas.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>

#include "core/error.h"
#include "core/system/interrupt.h"
#include "ink/spectra/colorimetry.h"
#include "ink/spectra/srgb.h"
#include "io/svg/style/svg_page.h"
#include "io/svg/svg_seams.h"
#include "io/svg/svg_stroke.h"

namespace tuft::io {
namespace {

constexpr double kStopStep = 8;                   // ΔE2000 between stops
constexpr int kMostBetween = 16;                  // stops between two of the file
constexpr std::size_t kMostMaskPieces = 20'000;   // of masked areas
constexpr double kSeen = 1.0 / 512;               // opacity
constexpr std::size_t kMostPairs = 100'000'000;   // of shapes in translucent groups whose extents are compared
constexpr std::size_t kMostCutWork = 20'000'000;  // points of shapes there that are cut by others
constexpr std::size_t kCutWork = 100;             // likewise, for a cut as such
constexpr double kLeastOverlap = 1e-6;            // of an area

ink::Lab lab_of(const SvgColour& c) {
    std::array<double, 3> linear{};
    for (std::size_t k = 0; k < 3; ++k) linear[k] = double(ink::srgb_decode(static_cast<float>(c.rgb[k])));
    return ink::lab_of_rgb(linear);
}

SvgColour mixed(const SvgColour& a, const SvgColour& b, double t) {
    SvgColour out;
    for (std::size_t k = 0; k < 3; ++k) out.rgb[k] = a.rgb[k] + t * (b.rgb[k] - a.rgb[k]);
    out.alpha = a.alpha + t * (b.alpha - a.alpha);
    return out;
}

/// Inks by colour.
class Inks {
  public:
    std::string of(const SvgColour& colour) {
        const std::string hex = hex_of(colour);
        if (const auto at = known_.find(hex); at != known_.end()) return at->second;
        const ink::Lab lab = lab_of(colour);
        for (const auto& [name, other] : inks_)
            if (ink::delta_e_2000(lab, other) <= kSameInk) return known_[hex] = name;
        inks_.emplace_back(hex, lab);
        return known_[hex] = hex;
    }

  private:
    std::map<std::string, std::string> known_;
    std::vector<std::pair<std::string, ink::Lab>> inks_;
};

/// The fill or the stroke of a shape.
struct PaintedPart {
    std::vector<Ring> rings;  ///< metres
    FillRule rule = FillRule::nonzero;
    SvgColour colour;
    SvgGradientPtr gradient;
    SvgPicturePtr picture;
    double opacity = 1;
    const SvgShape* shape = nullptr;
    std::vector<SvgLine> lines = {};  // of a stroke
};

std::vector<Ring> moved(std::vector<SvgLine> lines, const SvgMatrix& matrix) {
    for (SvgLine& line : lines)
        for (Vec2& p : line) p = Vec2(matrix * Vec3(p, 1));
    return lines;
}

/// What a shape paints, back to front.
std::vector<PaintedPart> parts_of(const SvgShape& s, double unit, double tolerance) {
    std::vector<PaintedPart> parts;
    if (!s.style.visible) return parts;
    const auto add = [&](const SvgPaint& paint, const SvgGradientPtr& gradient, double opacity, auto rings,
                         FillRule rule, auto lines) {
        if (!paint.paints_colours() || (paint.kind == SvgPaint::Kind::gradient && !gradient)) return;
        PaintedPart part{
            .rule = rule, .colour = paint.value, .gradient = gradient, .opacity = s.opacity * opacity, .shape = &s};
        if (!gradient) part.opacity *= paint.value.alpha;
        if (part.opacity < kSeen) return;
        part.rings = rings();
        std::erase_if(part.rings, [](const Ring& r) { return r.size() < 3; });
        if (part.rings.empty()) return;
        part.lines = lines();
        parts.push_back(std::move(part));
    };
    if (s.picture) {
        parts.push_back({.rings = moved(s.lines, s.matrix), .picture = s.picture, .opacity = s.opacity, .shape = &s});
        return parts;
    }
    add(
        s.style.fill, s.fill_gradient, s.style.fill_opacity, [&] { return moved(s.lines, s.matrix); }, s.style.rule,
        [] { return std::vector<SvgLine>(); });
    add(
        s.style.stroke, s.stroke_gradient, s.style.stroke_opacity,
        [&] { return svg_stroke_outline(s, unit, tolerance); }, FillRule::nonzero,
        [&] { return moved(s.lines, s.matrix); });
    if (s.style.stroke_first) std::ranges::reverse(parts);
    return parts;
}

double light_of(const SvgColour& c) {
    // Of linearRGB, as masks are by default in sRGB in practice: coefficients of SVG 1.1, 14.4.
    return 0.2125 * c.rgb[0] + 0.7154 * c.rgb[1] + 0.0721 * c.rgb[2];
}

/// A piece of an area and how much a mask lets through there.
struct MaskPiece {
    Shape region;
    double value = 0;     ///< from the mask's shapes so far
    double through = 1;   ///< of those behind them
    SvgGradientPtr fade;  ///< of a mask's gradient: the value is that of its stops
};

std::vector<Ring> page_rings(const Vec2& size) {
    if (!(size.x > 0 && size.y > 0)) return {};
    return {{Vec2(0), {size.x, 0}, size, {0, size.y}}};
}

class AreaMaker {
  public:
    AreaMaker(SvgScene& scene, const std::string& source, double tolerance)
        : scene_(scene), source_(source), tolerance_(tolerance), page_(page_rings(scene.page), FillRule::nonzero) {}

    std::vector<stroke::RecordedStroke> make() {
        std::vector<std::vector<PaintedPart>> all;
        for (const SvgShape& s : scene_.shapes) {
            check_interrupt();
            if (s.style.visible &&
                (s.style.fill.kind == SvgPaint::Kind::missing || s.style.stroke.kind == SvgPaint::Kind::missing))
                scene_.losses.add(SvgLoss::missing_paint);
            all.push_back(parts_of(s, scene_.unit, tolerance_));
            for (const PaintedPart& part : all.back())
                if (!part.gradient) inks_.of(part.colour);  // the drawing's own colours before those between stops
        }
        drop_background(all);
        cut_films(all);
        for (const std::vector<PaintedPart>& parts : all)
            for (const PaintedPart& part : parts) add(part);
        frame();
        extend_under();
        return std::move(out_);
    }

  private:
    // The page itself is bare.
    void drop_background(std::vector<std::vector<PaintedPart>>& all) {
        if (std::vector<PaintedPart>* first = first_painted(all); first && is_background(first->front(), scene_.page)) {
            first->erase(first->begin());
            scene_.losses.add(SvgLoss::white);
        }
    }
    // A translucent group is one film: its shapes hide each other as if they were opaque.
    void cut_films(std::vector<std::vector<PaintedPart>>& all) {
        std::map<std::size_t, std::vector<PaintedPart*>> films;
        for (std::vector<PaintedPart>& parts : all)
            for (PaintedPart& part : parts)
                if (part.shape->film > 0) films[part.shape->film].push_back(&part);
        for (auto& [number, parts] : films) cut_film(parts);
        for (std::vector<PaintedPart>& parts : all) std::erase_if(parts, [](const auto& p) { return p.rings.empty(); });
    }
    struct Extent {
        Vec2 low{HUGE_VAL}, high{-HUGE_VAL};
    };
    static Extent extent_of(const std::vector<Ring>& rings) {
        Extent e;
        for (const Ring& ring : rings)
            for (const Vec2& p : ring) e = {glm::min(e.low, p), glm::max(e.high, p)};
        return e;
    }
    struct FilmPart {
        PaintedPart* part = nullptr;
        Extent extent;
        std::optional<Shape> cover = {};     // within its clips
        std::vector<std::size_t> over = {};  // parts before it whose extents meet its own
    };
    void cut_film(const std::vector<PaintedPart*>& parts) {
        std::vector<FilmPart> film;
        std::map<std::size_t, Extent> clips;
        for (PaintedPart* part : parts) {
            Extent e = extent_of(part->rings);
            for (const std::size_t k : part->shape->clips) {
                const auto [at, is_new] = clips.try_emplace(k);
                if (is_new) at->second = extent_of(scene_.clips[k].rings());
                const Extent& clip = at->second;
                e = {glm::max(e.low, clip.low), glm::min(e.high, clip.high)};
            }
            film.push_back({part, e});
        }
        bool done = find_neighbours(film);
        for (std::size_t i = 0; done && i < film.size(); ++i) done = cut_by(film[i], film);
        if (!done) scene_.losses.add(SvgLoss::overlap);
    }
    // Whether there are not too many.
    bool find_neighbours(std::vector<FilmPart>& film) {
        std::vector<std::size_t> order(film.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::ranges::stable_sort(order, {}, [&](std::size_t i) { return film[i].extent.low.x; });
        std::size_t n_over = 0;
        for (std::size_t k = 0; k < order.size(); ++k) {
            check_interrupt();
            const Extent& a = film[order[k]].extent;
            for (std::size_t l = k + 1; l < order.size() && film[order[l]].extent.low.x < a.high.x; ++l) {
                if (++n_pairs_ > kMostPairs) return false;
                const Extent& b = film[order[l]].extent;
                if (b.high.x <= a.low.x || b.low.y >= a.high.y || b.high.y <= a.low.y) continue;
                if (++n_over > kMostCutWork / kCutWork) return false;
                film[std::min(order[k], order[l])].over.push_back(std::max(order[k], order[l]));
            }
        }
        for (FilmPart& one : film) std::ranges::sort(one.over);
        return true;
    }
    // Whether that is not too much work.
    bool cut_by(FilmPart& one, std::vector<FilmPart>& film) {
        PaintedPart& part = *one.part;
        one.cover.reset();  // those before it are done
        if (one.over.empty()) return true;
        Shape left(part.rings, part.rule);
        bool cut = false, shows = left.too_large(), done = true;
        for (std::size_t k = 0; k < one.over.size() && !left.empty(); ++k) {
            check_interrupt();
            FilmPart& other = film[one.over[k]];
            const Shape cover = cover_within(other, part.shape->clips);
            const std::size_t n = n_points_of(left.rings()) + n_points_of(cover.rings());
            if (n > Shape::kMostPoints || cover.too_large()) {
                shows = true;
                continue;
            }
            cut_work_ += kCutWork + n;
            done = cut_work_ <= kMostCutWork;
            if (!done) break;
            Shape after = left.without(cover);
            if (!after.too_large() && !(left.area() - after.area() > kLeastOverlap * left.area())) continue;
            if (after.too_large() || !is_solid(*other.part))
                shows = true;
            else
                left = std::move(after), cut = true;
        }
        if (shows) scene_.losses.add(SvgLoss::overlap);
        if (!cut) return done;
        part.rings = left.rings();
        part.rule = FillRule::nonzero;
        part.lines.clear();
        return done;
    }
    Shape cover_within(FilmPart& over, const std::vector<std::size_t>& clips) const {
        const PaintedPart& part = *over.part;
        if (!over.cover) {
            over.cover = Shape(part.rings, part.rule);
            for (const std::size_t k : part.shape->clips) over.cover = over.cover->intersected(scene_.clips[k]);
        }
        Shape cover = *over.cover;
        for (const std::size_t k : clips)
            if (!std::ranges::count(part.shape->clips, k)) cover = cover.intersected(scene_.clips[k]);
        return cover;
    }
    static bool is_solid(const PaintedPart& part) {
        return !part.gradient && !part.picture && part.shape->masks.empty() &&
               part.opacity > (1 - kSeen) * part.shape->film_opacity;
    }
    static std::size_t n_points_of(const std::vector<Ring>& rings) {
        std::size_t n = 0;
        for (const Ring& ring : rings) n += ring.size();
        return n;
    }
    static std::vector<PaintedPart>* first_painted(std::vector<std::vector<PaintedPart>>& all) {
        for (std::vector<PaintedPart>& parts : all)
            if (!parts.empty()) return &parts;
        return nullptr;
    }

  public:
    static bool is_background(const PaintedPart& part, const Vec2& page) {
        if (part.gradient || part.picture || part.opacity < 1 || part.colour != SvgColour{{1, 1, 1}, 1} ||
            part.rings.size() != 1 || !(page.x > 0 && page.y > 0) || !part.shape->clips.empty() ||
            !part.shape->masks.empty())
            return false;
        Vec2 low(HUGE_VAL), high(-HUGE_VAL);
        for (const Vec2& p : part.rings[0]) low = glm::min(low, p), high = glm::max(high, p);
        const Vec2 slack = 1e-3 * page;
        const Shape area(part.rings, part.rule);
        return low.x <= slack.x && low.y <= slack.y && high.x >= page.x - slack.x && high.y >= page.y - slack.y &&
               area.area() >= 0.999 * (high.x - low.x) * (high.y - low.y);
    }

  private:
    void add(const PaintedPart& part) {
        check_interrupt();
        const SvgShape& s = *part.shape;
        const auto whole = [&] { emit(part, part.rings, part.lines, part.rule == FillRule::even_odd, 1, nullptr); };
        const bool past_page = is_past_page(part.rings);
        if (s.clips.empty() && s.masks.empty() && !past_page) return whole();
        Shape region(part.rings, part.rule);
        if (past_page) region = region.intersected(page_);
        for (const std::size_t k : s.clips) region = region.intersected(scene_.clips[k]);
        if (region.too_large()) {
            scene_.losses.add(s.masks.empty() ? SvgLoss::clip : SvgLoss::mask);
            return whole();
        }
        std::vector<MaskPiece> pieces{{std::move(region), 1, 1, nullptr}};
        for (const std::size_t k : s.masks) pieces = masked(std::move(pieces), scene_.masks[k]);
        for (const MaskPiece& piece : pieces)
            if (!piece.region.empty())
                emit(part, piece.region.rings(), pieces.size() == 1 ? part.lines : std::vector<SvgLine>(), false,
                     piece.value, piece.fade);
    }

    // What lies beside the page is not seen in any viewer.
    bool is_past_page(const std::vector<Ring>& rings) const {
        if (page_.empty()) return false;
        const Vec2 slack = 1e-6 * scene_.page;
        for (const Ring& ring : rings)
            for (const Vec2& p : ring)
                if (p.x < -slack.x || p.y < -slack.y || p.x > scene_.page.x + slack.x || p.y > scene_.page.y + slack.y)
                    return true;
        return false;
    }

    std::vector<MaskPiece> masked(std::vector<MaskPiece> before, const SvgMask& mask) {
        std::vector<MaskPiece> out;
        for (MaskPiece& whole : before) {
            std::vector<MaskPiece> open{{std::move(whole.region), 0, 1, nullptr}};
            for (auto s = mask.shapes.rbegin(); s != mask.shapes.rend(); ++s) {
                std::vector<PaintedPart> parts = parts_of(*s, scene_.unit, tolerance_);
                for (auto part = parts.rbegin(); part != parts.rend(); ++part)
                    open = under(std::move(open), *part, mask.alpha);
            }
            for (MaskPiece& piece : open) {
                piece.value *= whole.value;
                if (whole.fade && !piece.fade) piece.fade = whole.fade;
                if (piece.value >= kSeen || piece.fade) out.push_back(std::move(piece));
            }
        }
        return out;
    }

    // Pieces split by one shape of a mask, which lies behind those before.
    std::vector<MaskPiece> under(std::vector<MaskPiece> pieces, const PaintedPart& part, bool alpha) {
        Shape region(part.rings, part.rule);
        for (const std::size_t k : part.shape->clips) region = region.intersected(scene_.clips[k]);
        std::vector<MaskPiece> out;
        for (MaskPiece& piece : pieces) {
            if (piece.through < kSeen || piece.fade) {
                out.push_back(std::move(piece));
                continue;
            }
            MaskPiece inside = piece;
            inside.region = piece.region.intersected(region);
            piece.region = piece.region.without(region);
            if (part.gradient && piece.value == 0 && part.opacity > 1 - kSeen) {
                inside.fade = fade_of(*part.gradient, alpha);
                inside.value = 1, inside.through = 0;
            } else {
                if (part.gradient) scene_.losses.add(SvgLoss::mask);
                const SvgColour colour = part.gradient ? part.gradient->stops.front().colour : part.colour;
                inside.value += piece.through * part.opacity * (alpha ? 1 : light_of(colour));
                inside.through *= 1 - part.opacity;
            }
            if (!inside.region.empty()) out.push_back(std::move(inside));
            if (!piece.region.empty()) out.push_back(std::move(piece));
            if ((n_pieces_ += 2) > kMostMaskPieces)
                throw Error(source_, "a mask cuts the drawing into too many pieces");
        }
        return out;
    }

    static SvgGradientPtr fade_of(const SvgGradient& gradient, bool alpha) {
        auto fade = std::make_shared<SvgGradient>(gradient);
        for (SvgStop& stop : fade->stops) stop.colour.alpha *= alpha ? 1 : light_of(stop.colour);
        return fade;
    }

    void emit(const PaintedPart& part, std::vector<Ring> rings, std::vector<SvgLine> lines, bool even_odd, double value,
              const SvgGradientPtr& fade) {
        for (const auto* paths : {&rings, &lines})
            for (const auto& path : *paths) n_points_ += path.size();
        if (n_points_ > stroke::kMaxAreaPoints) throw Error(source_, "the drawing has too many points");
        stroke::FlatArea area{.rings = std::move(rings),
                              .even_odd = even_odd,
                              .lines = std::move(lines),
                              .placement = {},
                              .reading = {.part = part.shape->upright, .centre = Vec2{0}},
                              .stops = {}};
        const double opacity = part.opacity * value;
        SvgGradientPtr gradient = part.gradient;
        if (fade && gradient) scene_.losses.add(SvgLoss::mask);
        if (fade && !gradient) {
            auto graded = std::make_shared<SvgGradient>(*fade);
            for (SvgStop& stop : graded->stops) stop.colour.rgb = part.colour.rgb;
            gradient = graded;
        }
        if (part.picture)
            shade(area, *part.picture, opacity, bool(fade));
        else if (gradient)
            grade(area, *gradient, opacity);
        else
            area.stops = {{.ink = inks_.of(part.colour), .opacity = std::min(1.0, opacity)}};
        if (std::all_of(area.stops.begin(), area.stops.end(), [](const auto& s) { return s.opacity < kSeen; })) return;
        stroke::RecordedStroke recorded;
        recorded.group = part.shape->group;
        recorded.before.push_back(stroke::fill_of_area(std::move(area)));
        out_.push_back(std::move(recorded));
    }

    // Black with the opacity of the picture's darkness.
    void shade(stroke::FlatArea& area, const SvgPicture& picture, double opacity, bool faded) {
        constexpr int kShades = 16;
        if (faded) scene_.losses.add(SvgLoss::mask);
        const std::string ink = inks_.of({{0, 0, 0}, 1});
        for (int k = 0; k <= kShades; ++k) {
            const double t = double(k) / kShades;
            area.stops.push_back({.at = t, .ink = ink, .opacity = std::min(1.0, opacity * t)});
        }
        area.gradient = stroke::AreaGradient::image;
        area.image = *picture.pixels;
        const SvgMatrix& m = picture.to_unit;
        area.to_unit = {m[0][0], m[0][1], m[1][0], m[1][1], m[2][0], m[2][1]};
    }

    void grade(stroke::FlatArea& area, const SvgGradient& g, double opacity) {
        const auto stop_at = [&](double at, const SvgColour& c) {
            area.stops.push_back({.at = at, .ink = inks_.of(c), .opacity = std::min(1.0, opacity * c.alpha)});
        };
        if (g.stops.size() == 1) {
            stop_at(0, g.stops[0].colour);
            return;
        }
        stop_at(g.stops[0].at, g.stops[0].colour);
        for (std::size_t i = 1; i < g.stops.size(); ++i) {
            const SvgStop &a = g.stops[i - 1], &b = g.stops[i];
            const double apart = ink::delta_e_2000(lab_of(a.colour), lab_of(b.colour)) / kStopStep +
                                 8 * std::abs(a.colour.alpha - b.colour.alpha);
            const int n = b.at > a.at ? std::clamp(static_cast<int>(std::ceil(apart)), 1, kMostBetween) : 1;
            for (int k = 1; k <= n && area.stops.size() < stroke::kMaxAreaStops; ++k)
                stop_at(a.at + (b.at - a.at) * k / n, mixed(a.colour, b.colour, double(k) / n));
        }
        area.gradient = g.radial ? stroke::AreaGradient::radial : stroke::AreaGradient::linear;
        area.spread = static_cast<stroke::AreaSpread>(g.spread);
        const SvgMatrix& m = g.to_unit;
        area.to_unit = {m[0][0], m[0][1], m[1][0], m[1][1], m[2][0], m[2][1]};
        area.focus = g.focus;
    }

    static stroke::FlatArea& area_of(stroke::RecordedStroke& r) {
        return *std::get<stroke::Fill>(r.before.front()).area;
    }

    void extend_under() {
        std::vector<stroke::FlatArea*> areas;
        for (stroke::RecordedStroke& recorded : out_) areas.push_back(&area_of(recorded));
        set_under(areas);
    }

    // Bounds of the drawing, and middles of what stays upright.
    void frame() {
        Vec2 low(HUGE_VAL), high(-HUGE_VAL);
        std::map<std::string, std::pair<Vec2, Vec2>> upright;
        for (stroke::RecordedStroke& recorded : out_) {
            stroke::FlatArea& area = area_of(recorded);
            auto& part = upright.try_emplace(area.reading.part, Vec2(HUGE_VAL), Vec2(-HUGE_VAL)).first->second;
            for (const auto& ring : area.rings)
                for (const Vec2& p : ring) part = {glm::min(part.first, p), glm::max(part.second, p)};
            low = glm::min(low, part.first), high = glm::max(high, part.second);
        }
        for (stroke::RecordedStroke& recorded : out_) {
            stroke::FlatArea& area = area_of(recorded);
            area.low = low, area.high = high;
            const auto& [from, to] = upright.at(area.reading.part);
            if (!area.reading.part.empty()) area.reading.centre = 0.5 * (from + to);
        }
    }

    SvgScene& scene_;
    const std::string& source_;
    double tolerance_;
    Shape page_;
    Inks inks_;
    std::vector<stroke::RecordedStroke> out_;
    std::size_t n_points_ = 0, n_pieces_ = 0, n_pairs_ = 0, cut_work_ = 0;
};

}  // namespace

SvgShape svg_with_own_width(SvgShape s, double unit) {
    if (!s.fixed_width) return s;
    s.lines = moved(std::move(s.lines), s.matrix);
    s.matrix = SvgMatrix(1);
    s.style.pen.width *= unit;
    s.style.pen.dash_offset *= unit;
    for (double& d : s.style.pen.dashes) d *= unit;
    s.fixed_width = false;
    return s;
}

std::vector<Ring> svg_stroke_outline(const SvgShape& s, double unit, double tolerance) {
    if (s.fixed_width) return svg_stroke_outline(svg_with_own_width(s, unit), unit, tolerance);
    const double growth = std::max(svg_growth(s.matrix), 1e-12);
    std::vector<Ring> rings;
    for (const SvgLine& line : s.lines)
        for (SvgLine& ring : svg_stroke_rings(line, s.style, tolerance / growth)) rings.push_back(std::move(ring));
    return moved(std::move(rings), s.matrix);
}

bool has_colours(const SvgScene& scene) {
    bool first = true;
    for (const SvgShape& s : scene.shapes) {
        if (!s.style.visible) continue;
        for (const PaintedPart& part : parts_of(s, scene.unit, 1)) {
            if (part.gradient || part.picture) return true;
            const bool background = std::exchange(first, false) && AreaMaker::is_background(part, scene.page);
            if (!background && part.colour.rgb != std::array<double, 3>{0, 0, 0}) return true;
        }
    }
    return false;
}

std::vector<stroke::RecordedStroke> svg_areas(SvgScene& scene, const std::string& source, double tolerance) {
    return AreaMaker(scene, source, tolerance).make();
}

}  // namespace tuft::io
