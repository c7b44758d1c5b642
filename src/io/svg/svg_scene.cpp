#include "io/svg/svg_scene.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <numbers>
#include <optional>
#include <pugixml.hpp>
#include <utility>

#include "core/error.h"
#include "core/system/interrupt.h"
#include "io/strokes/inkml_marks.h"
#include "io/svg/style/svg_page.h"
#include "io/svg/svg_pattern.h"
#include "io/svg/svg_text.h"

namespace tuft::io {
namespace {

constexpr int kDeepest = 64;                             // of nested groups and references
constexpr std::size_t kMostElements = 1'000'000;         // drawn, each `use` of one counted
constexpr std::size_t kMostText = std::size_t{1} << 30;  // bytes of attributes read, those of each `use` counted
constexpr std::size_t kMostMatches = 200'000'000;        // rules of style sheets times elements
constexpr std::size_t kMostMarkers = 100'000;            // of one line

/// What holds for an element and all within it.
struct State {
    SvgMatrix matrix{1};
    SvgStyle style;
    double opacity = 1, film_opacity = 1;
    std::size_t film = 0;
    std::vector<std::size_t> clips, masks;
    std::string group, upright;
    Vec2 page{0};  ///< size of the viewport, user units
};

class SceneReader {
  public:
    SceneReader(const std::string& source, const SvgSceneOptions& options)
        : source_(source), options_(options), pictures_(options.folder) {}

    SvgScene read(const pugi::xml_node& svg) {
        index(svg);
        read_sheets(svg, 0);
        const SvgPage page = svg_page(svg, source_);
        scene_.page = page.size;
        scene_.unit = svg_growth(page.frame);
        State state{.matrix = page.frame, .page = page.view};
        walk(svg, std::move(state), 0);
        return std::move(scene_);
    }

  private:
    /// Properties of one element.
    class Properties {
      public:
        Properties(const pugi::xml_node& node, SvgDeclarations declared)
            : node_(node), declared_(std::move(declared)) {}
        /// "" where nothing says it, or where it is handed down anyway.
        std::string operator()(const char* name) const {
            const auto at = declared_.find(name);
            std::string value = at != declared_.end() ? at->second : node_.attribute(name).value();
            return value == "inherit" ? std::string() : value;
        }
        bool declares(const char* name) const { return declared_.contains(name); }

      private:
        const pugi::xml_node& node_;
        SvgDeclarations declared_;
    };

    void walk(const pugi::xml_node& node, State state, int depth) {
        if (depth > kDeepest) throw Error(source_, "groups are nested too deeply");
        count(node);
        const std::string name(local_name(node));
        static constexpr const char* skipped[] = {"defs",    "symbol",   "clipPath", "mask",  "marker",
                                                  "pattern", "metadata", "style",    "title", "desc"};
        if (std::find(std::begin(skipped), std::end(skipped), name) != std::end(skipped) || is_lost(node, name)) return;
        const Properties own(node, sheet_.declared(node));
        if (own("display") == "none" || svg_part(own("opacity"), 1) == 0) return;
        inherit_style(state.style, std::cref(own), by_id_, source_);
        if (name == "image" && !state.style.visible) return;
        if (name == "image" && options_.brush) return scene_.losses.add(SvgLoss::image);
        count_effects(own);
        state.opacity *= svg_part(own("opacity"), 1);
        if (state.film == 0 && state.opacity < 1) state.film = ++n_films_, state.film_opacity = state.opacity;
        name_group(node, name, own, state, depth);
        const bool inner = name == "svg" && depth > 0;
        if (inner && options_.brush && (node.attribute("x") || node.attribute("y") || node.attribute("viewBox")))
            scene_.losses.add(SvgLoss::frame);
        if (const auto transform = node.attribute("transform"))
            state.matrix = state.matrix * svg_transform(transform.value(), source_);
        if (!options_.brush) {
            add_effects(node, own, state, depth);
            if (inner) enter_frame(node, state, viewport_of(node, state, 1), overflows(own));
        }
        if (name == "image") return picture(node, own, std::move(state));
        if (name == "use") return use(node, std::move(state), depth);
        if (name == "text") return text(node, own, std::move(state), depth);
        if (state.style.visible) shape(node, name, own, state, depth);
        if (name == "switch" && !options_.brush) return choose(node, state, depth);
        children(node, state, depth);
    }

    void count(const pugi::xml_node& node) {
        check_interrupt();
        if (++n_elements_ > kMostElements) throw Error(source_, "there are too many elements in it");
        if ((n_matches_ += sheet_.size()) > kMostMatches) throw Error(source_, "its style sheets take too long");
        for (const pugi::xml_attribute& one : node.attributes()) n_text_ += std::strlen(one.value());
        if (n_text_ > kMostText) throw Error(source_, "what 'use' repeats makes it too large");
    }

    void children(const pugi::xml_node& node, const State& state, int depth) {
        for (const pugi::xml_node& child : node.children())
            if (child.type() == pugi::node_element) walk(child, state, depth + 1);
    }
    // The first child that asks for nothing special.
    void choose(const pugi::xml_node& node, const State& state, int depth) {
        for (const pugi::xml_node& child : node.children()) {
            const auto language = child.attribute("systemLanguage");
            const bool foreign = language && std::string_view(language.value()).find("en") == std::string_view::npos;
            if (child.type() == pugi::node_element && local_name(child) != "foreignObject" &&
                !child.attribute("requiredExtensions") && !foreign)
                return walk(child, state, depth + 1);
        }
    }

    // A layer or the outermost group with a name; text and marked groups stay readable in a mirrored copy.
    void name_group(const pugi::xml_node& node, const std::string& name, const Properties& own, State& state,
                    int depth) {
        if (depth == 0 || (name != "g" && name != "svg" && name != "a" && name != "use")) return;
        std::string label = node.attribute("inkscape:label").value();
        const std::string id = node.attribute("id").value();
        if (label.empty()) label = node.attribute("data-name").value();
        if (label.empty()) label = id;
        const bool layer = std::string_view(node.attribute("inkscape:groupmode").value()) == "layer";
        if (!label.empty() && name == "g" && (layer || state.group.empty())) state.group = label;
        const std::string marked = node.attribute("data-readable").value();
        std::string words = std::string(" ") + node.attribute("class").value() + " ";
        if (state.upright.empty() && (words.find(" readable ") != words.npos ||
                                      (!marked.empty() && marked != "false") || own("--readable") == "true"))
            state.upright = label.empty() ? "readable " + std::to_string(++n_upright_) : label;
    }

    // Another element drawn here; one that is not in the file draws nothing. A symbol is its children, in the
    // frame of its viewBox.
    void use(const pugi::xml_node& node, State state, int depth) {
        const std::string target = svg_href(node);
        const bool inside = target.starts_with('#');
        const auto at = inside ? by_id_.find(target.substr(1)) : by_id_.end();
        if (at == by_id_.end())
            return scene_.losses.add(inside || target.empty() ? SvgLoss::missing_use : SvgLoss::outside_use);
        state.matrix = state.matrix * svg_translation(number(node, "x", state), number(node, "y", state));
        const std::string name(local_name(at->second));
        if (name != "symbol" && (name != "svg" || options_.brush)) return walk(at->second, std::move(state), depth + 1);
        if (depth + 1 > kDeepest) throw Error(source_, "groups are nested too deeply");
        count(at->second);
        const Properties own(at->second, sheet_.declared(at->second));
        if (!options_.brush) {
            inherit_style(state.style, std::cref(own), by_id_, source_);
            enter_frame(at->second, state, {Vec2(0), use_size(node, at->second, state)}, overflows(own));
        } else if (const std::string box = at->second.attribute("viewBox").value(); !box.empty()) {
            SvgReader in(box, source_);
            const double x = in.number(), y = in.number(), w = in.number(), wanted = number(node, "width", state);
            const double scale = wanted > 0 && w > 0 ? wanted / w : 1;
            state.matrix = state.matrix * svg_scaling(scale, scale) * svg_translation(-x, -y);
        }
        children(at->second, state, depth + 1);
    }

    Vec2 use_size(const pugi::xml_node& node, const pugi::xml_node& target, const State& state) const {
        const auto side = [&](const char* name, double whole) {
            if (node.attribute(name)) return number(node, name, state);
            if (local_name(target) == "svg" && target.attribute(name)) return number(target, name, state);
            return whole;
        };
        return {side("width", state.page.x), side("height", state.page.y)};
    }

    SvgViewport viewport_of(const pugi::xml_node& node, const State& state, double whole) const {
        return {{number(node, "x", state), number(node, "y", state)},
                {node.attribute("width") ? number(node, "width", state) : whole * state.page.x,
                 node.attribute("height") ? number(node, "height", state) : whole * state.page.y}};
    }
    static bool overflows(const Properties& own) {
        const std::string value = own("overflow");
        return value == "visible" || value == "auto";
    }
    /// Moves into the frame of an inner `svg`, a `symbol` or a `marker`: its viewBox fills the viewport (SVG 1.1, 7.8).
    void enter_frame(const pugi::xml_node& node, State& state, const SvgViewport& port, bool overflow) {
        if (!(port.size.x > 0 && port.size.y > 0)) {
            state.style.visible = false;
            return;
        }
        if (!overflow) clip_to(state, port);
        const SvgFraming framing = svg_framing(node, port, source_);
        state.matrix = state.matrix * framing.matrix;
        state.page = framing.view;
    }
    void clip_to(State& state, const SvgViewport& port) {
        const Vec2 &a = port.corner, b = a + port.size;
        add_clip(state, {{a, {b.x, a.y}, b, {a.x, b.y}}});
    }
    // What lies within lines of the user space.
    void add_clip(State& state, std::vector<SvgLine> lines, FillRule rule = FillRule::nonzero) {
        for (SvgLine& line : lines)
            for (Vec2& p : line) p = Vec2(state.matrix * Vec3(p, 1));
        put_clip(state, lines, rule);
    }
    void put_clip(State& state, const std::vector<Ring>& rings, FillRule rule) {
        std::size_t n = 0;
        for (const Ring& ring : rings) n += ring.size();
        if (n > Shape::kMostPoints) return scene_.losses.add(SvgLoss::clip);
        if (scene_.clips.size() > kMostElements) throw Error(source_, "there are too many clip paths in it");
        state.clips.push_back(scene_.clips.size());
        scene_.clips.emplace_back(rings, rule);
    }

    // Elements that leave nothing; whether this is one.
    bool is_lost(const pugi::xml_node& node, const std::string& name) {
        if (name == "foreignObject" && local_name(node.parent()) == "switch")
            return true;  // another child takes its place
        if (name == "foreignObject" || name == "video" || name == "iframe" || name == "canvas")
            scene_.losses.add(SvgLoss::foreign);
        else if (name == "animate" || name == "animateTransform" || name == "animateMotion" || name == "animateColor" ||
                 name == "set")
            scene_.losses.add(SvgLoss::animation);
        else if (name == "script")
            scene_.losses.add(SvgLoss::script);
        else
            return false;
        return true;
    }

    // What an element does to all within it, where it is not done.
    void count_effects(const Properties& own) {
        const auto used = [&](const char* name) {
            const std::string value = own(name);
            return !value.empty() && value != "none" && value != "normal";
        };
        if (options_.brush && used("clip-path")) scene_.losses.add(SvgLoss::clip);
        if (options_.brush && used("mask")) scene_.losses.add(SvgLoss::mask);
        if (used("filter")) scene_.losses.add(SvgLoss::filter);
        if (used("mix-blend-mode")) scene_.losses.add(SvgLoss::blend);
        if (options_.brush && svg_part(own("opacity"), 1) < 1) scene_.losses.add(SvgLoss::opacity);
        if (own.declares("transform") && used("transform")) scene_.losses.add(SvgLoss::transform);
    }

    // The shapes that `draw` adds, apart from the drawing's.
    template <class Draw>
    std::vector<SvgShape> apart(const Draw& draw) {
        std::vector<SvgShape> own;
        std::swap(own, scene_.shapes);
        draw();
        std::swap(own, scene_.shapes);
        return own;
    }

    /// Bounds of an element in its own user space, for units of its bounding box.
    std::pair<Vec2, Vec2> bounds_of(const pugi::xml_node& node, const State& state, int depth) {
        Vec2 low(HUGE_VAL), high(-HUGE_VAL);
        const auto extend = [&](const std::vector<SvgShape>& shapes, const SvgMatrix& back) {
            for (const SvgShape& s : shapes)
                for (const SvgLine& line : s.lines)
                    for (const Vec2& p : line) {
                        const Vec2 q(back * (s.matrix * Vec3(p, 1)));
                        low = glm::min(low, q), high = glm::max(high, q);
                    }
        };
        State plain{.matrix = state.matrix, .page = state.page};
        const std::string name(local_name(node));
        extend(apart([&] {
                   if (name == "use")
                       use(node, plain, depth);
                   else if (name == "text")
                       text(node, Properties(node, sheet_.declared(node)), plain, depth);
                   else
                       shape(node, name, Properties(node, {}), plain, depth), children(node, plain, depth);
               }),
               glm::inverse(state.matrix));
        return {low, high};
    }

    void add_effects(const pugi::xml_node& node, const Properties& own, State& state, int depth) {
        if (const std::string id = svg_reference(own("clip-path")); !id.empty()) {
            const auto at = by_id_.find(id);
            if (at == by_id_.end() || local_name(at->second) != "clipPath")
                scene_.losses.add(SvgLoss::clip);
            else
                clip_by(at->second, node, state, depth);
        }
        if (const std::string id = svg_reference(own("mask")); !id.empty()) {
            const auto at = by_id_.find(id);
            if (at == by_id_.end() || local_name(at->second) != "mask")
                scene_.losses.add(SvgLoss::mask);
            else
                mask_by(at->second, node, state, depth);
        }
    }

    SvgMatrix content_matrix(const pugi::xml_node& node, const char* units, const pugi::xml_node& user,
                             const State& state, int depth) {
        if (std::string_view(node.attribute(units).value()) != "objectBoundingBox") return state.matrix;
        const auto [low, high] = bounds_of(user, state, depth);
        if (!(low.x < high.x && low.y < high.y)) return state.matrix * svg_scaling(0, 0);
        return state.matrix * svg_translation(low.x, low.y) * svg_scaling(high.x - low.x, high.y - low.y);
    }

    // What an element of `defs` inherits: the properties of the elements round it, not of those that refer to it.
    SvgStyle style_round(const pugi::xml_node& node) const {
        std::vector<pugi::xml_node> parents;
        for (pugi::xml_node p = node.parent(); p.type() == pugi::node_element; p = p.parent()) parents.push_back(p);
        SvgStyle style;
        for (auto p = parents.rbegin(); p != parents.rend(); ++p)
            inherit_style(style, Properties(*p, sheet_.declared(*p)), by_id_, source_);
        return style;
    }

    void clip_by(const pugi::xml_node& clip, const pugi::xml_node& user, State& state, int depth) {
        if (depth > kDeepest) throw Error(source_, "clip paths refer to each other");
        State inside{.matrix = content_matrix(clip, "clipPathUnits", user, state, depth),
                     .style = style_round(clip),
                     .page = state.page};
        if (const auto transform = clip.attribute("transform"))
            inside.matrix = inside.matrix * svg_transform(transform.value(), source_);
        const Properties own(clip, sheet_.declared(clip));
        inherit_style(inside.style, std::cref(own), by_id_, source_);
        add_effects(clip, own, inside, depth + 1);
        const std::vector<std::size_t> outer = std::exchange(inside.clips, {});
        std::vector<Ring> rings;
        for (const SvgShape& s : apart([&] { children(clip, inside, depth + 1); })) {
            std::vector<SvgLine> lines = s.lines;
            for (SvgLine& line : lines)
                for (Vec2& p : line) p = Vec2(s.matrix * Vec3(p, 1));
            Shape part(lines, s.style.clip_rule);
            for (const std::size_t k : s.clips) part = part.intersected(scene_.clips[k]);
            rings.insert(rings.end(), part.rings().begin(), part.rings().end());
        }
        state.clips.insert(state.clips.end(), outer.begin(), outer.end());
        put_clip(state, rings, FillRule::nonzero);
    }

    void mask_by(const pugi::xml_node& mask, const pugi::xml_node& user, State& state, int depth) {
        if (depth > kDeepest) throw Error(source_, "masks refer to each other");
        State inside{.matrix = content_matrix(mask, "maskContentUnits", user, state, depth),
                     .style = style_round(mask),
                     .page = state.page};
        const Properties own(mask, sheet_.declared(mask));
        inherit_style(inside.style, std::cref(own), by_id_, source_);
        SvgMask made{.shapes = apart([&] { children(mask, inside, depth + 1); }), .alpha = own("mask-type") == "alpha"};
        state.masks.push_back(scene_.masks.size());
        scene_.masks.push_back(std::move(made));
    }

    void shape(const pugi::xml_node& node, const std::string& name, const Properties& own, const State& state,
               int depth) {
        bool damaged = false;
        std::vector<SvgLine> lines = svg_lines(node, name, curves(state.matrix), state.page, source_, &damaged);
        if (damaged) scene_.losses.add(SvgLoss::damaged_path);
        if (!lines.empty()) add_shape(std::move(lines), own, state, depth, name);
    }

    // A picture fills its rectangle as a stencil (SVG 1.1, 5.7).
    void picture(const pugi::xml_node& node, const Properties& own, State state) {
        std::shared_ptr<const stroke::AreaImage> pixels;
        try {
            pixels = pictures_.read(svg_href(node));
        } catch (const Error& e) {
            return scene_.losses.add_image(e.message());
        }
        const auto side = [&](const char* name, int whole) {
            return node.attribute(name) ? number(node, name, state) : whole;
        };
        const SvgViewport port{{number(node, "x", state), number(node, "y", state)},
                               {side("width", pixels->width), side("height", pixels->height)}};
        std::optional<SvgPlacedPicture> placed =
            svg_place_picture(std::move(pixels), node, {port, state.matrix}, source_);
        if (!placed) return;
        if (!overflows(own)) clip_to(state, port);
        scene_.shapes.push_back(shape_in({std::move(placed->rectangle)}, state));
        scene_.shapes.back().picture = std::move(placed->picture);
    }

    // Glyphs as areas. A mirrored copy keeps a text readable.
    void text(const pugi::xml_node& node, const Properties& own, State state, int depth) {
        if (state.upright.empty()) state.upright = "text " + std::to_string(++n_upright_);
        const SvgTextContext context{
            .style_of = [this](const pugi::xml_node& element, const SvgStyle& parent) -> std::optional<SvgStyle> {
                count(element);
                const Properties inner(element, sheet_.declared(element));
                if (inner("display") == "none") return std::nullopt;
                SvgStyle style = parent;
                inherit_style(style, std::cref(inner), by_id_, source_);
                return style;
            },
            .path_of = [&](const pugi::xml_node& along) { return text_path(along, state); },
            .fonts = fonts_,
            .losses = scene_.losses,
            .page = state.page,
            .growth = svg_growth(state.matrix),
            .tolerance = options_.tolerance,
            .source = source_};
        for (SvgTextShape& glyphs : set_svg_text(node, state.style, context)) {
            state.style = glyphs.style;
            add_shape(std::move(glyphs.lines), own, state, depth, "text");
        }
    }

    std::vector<SvgLine> text_path(const pugi::xml_node& along, const State& state) const {
        const std::string target = svg_href(along);
        const auto at = target.size() > 1 ? by_id_.find(target.substr(1)) : by_id_.end();
        if (at == by_id_.end()) return {};
        return svg_transformed_lines(at->second, curves(state.matrix), state.page, source_);
    }

    static SvgShape shape_in(std::vector<SvgLine> lines, const State& state) {
        return {.lines = std::move(lines),
                .matrix = state.matrix,
                .style = state.style,
                .opacity = state.opacity,
                .film = state.film,
                .film_opacity = state.film_opacity,
                .clips = state.clips,
                .masks = state.masks,
                .group = state.group,
                .upright = state.upright};
    }

    void add_shape(std::vector<SvgLine> lines, const Properties& own, const State& state, int depth,
                   std::string_view name) {
        for (const SvgLine& line : lines) n_points_ += line.size();
        if (n_points_ > options_.max_points) throw Error(source_, "the drawing has too many points");
        SvgShape shape = shape_in(std::move(lines), state);
        shape.fixed_width = own("vector-effect") == "non-scaling-stroke";
        if (options_.brush) {
            scene_.shapes.push_back(std::move(shape));
            return;
        }
        Vec2 low(HUGE_VAL), high(-HUGE_VAL);
        for (const SvgLine& line : shape.lines)
            for (const Vec2& p : line) low = glm::min(low, p), high = glm::max(high, p);
        const SvgGradientUse use{state.matrix, low, high, state.page};
        const auto gradient_of = [&](SvgPaint& paint) -> SvgGradientPtr {
            if (paint.kind != SvgPaint::Kind::gradient) return nullptr;
            auto gradient = svg_gradient(paint.server, use, by_id_, sheet_, source_);
            if (!gradient) paint.kind = SvgPaint::Kind::none;
            return gradient ? std::make_shared<const SvgGradient>(std::move(*gradient)) : nullptr;
        };
        shape.fill_gradient = gradient_of(shape.style.fill);
        shape.stroke_gradient = gradient_of(shape.style.stroke);
        if (shape.style.stroke.kind == SvgPaint::Kind::pattern) {
            scene_.losses.add(SvgLoss::pattern);
            shape.style.stroke.kind = SvgPaint::Kind::none;
        }
        if (shape.style.fill.kind == SvgPaint::Kind::pattern) {
            pattern(shape, {low, high}, state, depth);
            shape.style.fill.kind = SvgPaint::Kind::none;
        }
        const bool marked =
            shape.style.marked() && (name == "path" || name == "line" || name == "polyline" || name == "polygon");
        const std::vector<SvgLine> line_copy = marked ? shape.lines : std::vector<SvgLine>();
        scene_.shapes.push_back(std::move(shape));
        if (marked) markers(line_copy, state, depth);
    }

    // The tiles of a pattern, back to front, within the shape (SVG 1.1, 13.3).
    void pattern(const SvgShape& shape, const std::pair<Vec2, Vec2>& bounds, const State& state, int depth) {
        if (depth > kDeepest) throw Error(source_, "patterns refer to each other");
        const std::vector<pugi::xml_node> chain = svg_pattern_chain(shape.style.fill.server, by_id_);
        const auto filled =
            std::find_if(chain.begin(), chain.end(), [](const pugi::xml_node& one) { return bool(one.first_child()); });
        if (filled == chain.end()) return;
        const std::optional<SvgPatternGrid> grid = svg_pattern_grid(chain, bounds, state.page, source_);
        if (!grid) return;
        const auto& [corner, tile, own, from, to] = *grid;
        const pugi::xml_node content = *filled;
        const Vec2 size = bounds.second - bounds.first;
        State inside = state;
        inside.matrix = state.matrix * own;
        inside.style = style_round(content);
        inside.opacity = shape.opacity * shape.style.fill_opacity;
        if (inside.film == 0 && inside.opacity < 1) inside.film = ++n_films_, inside.film_opacity = inside.opacity;
        State outer = state;
        add_clip(outer, shape.lines, shape.style.rule);
        inside.clips.push_back(outer.clips.back());
        const std::string box = svg_chain_text(chain, "viewBox");
        const bool content_in_box = box.empty() && svg_chain_text(chain, "patternContentUnits") == "objectBoundingBox";
        for (double j = from.y; j < to.y; ++j)
            for (double i = from.x; i < to.x; ++i) {
                State one = inside;
                one.matrix = inside.matrix * svg_translation(corner.x + i * tile.x, corner.y + j * tile.y);
                add_clip(one, {{Vec2(0), {tile.x, 0}, tile, {0, tile.y}}});
                if (!box.empty())
                    one.matrix = one.matrix * svg_framing(content, {Vec2(0), tile}, source_).matrix;
                else if (content_in_box)
                    one.matrix = one.matrix * svg_scaling(size.x, size.y);
                else
                    one.matrix = one.matrix * svg_translation(-corner.x, -corner.y);
                children(content, one, depth + 1);
            }
    }

    void markers(const std::vector<SvgLine>& lines, const State& state, int depth) {
        const std::vector<std::pair<Vec2, double>> at = svg_vertices(lines);
        if (at.empty() || at.size() > kMostMarkers) return;
        marker(state.style.marker_start, at.front(), true, state, depth);
        if (!state.style.marker_mid.empty()) {
            // Vertices of curves that became chords have none.
            if (lines.size() == 1 && at.size() <= 1000)
                for (std::size_t i = 1; i + 1 < at.size(); ++i)
                    marker(state.style.marker_mid, at[i], false, state, depth);
            else
                scene_.losses.add(SvgLoss::marker);
        }
        marker(state.style.marker_end, at.back(), false, state, depth);
    }

    void marker(const std::string& id, const std::pair<Vec2, double>& at, bool start, const State& state, int depth) {
        const auto found = by_id_.find(id);
        if (id.empty() || found == by_id_.end() || local_name(found->second) != "marker") return;
        if (depth > kDeepest) throw Error(source_, "markers refer to each other");
        const pugi::xml_node& node = found->second;
        State inside = state;
        inside.matrix = state.matrix * svg_translation(at.first.x, at.first.y);
        inside.style = style_round(node);
        const Properties own(node, sheet_.declared(node));
        inherit_style(inside.style, std::cref(own), by_id_, source_);
        const std::string orient = node.attribute("orient").value();
        double angle = orient.starts_with("auto")
                           ? at.second + (start && orient == "auto-start-reverse" ? std::numbers::pi : 0)
                       : orient.empty() ? 0
                                        : SvgReader(orient, source_).number() * std::numbers::pi / 180;
        inside.matrix = inside.matrix *
                        SvgMatrix(std::cos(angle), std::sin(angle), 0, -std::sin(angle), std::cos(angle), 0, 0, 0, 1);
        if (std::string_view(node.attribute("markerUnits").value()) != "userSpaceOnUse")
            inside.matrix = inside.matrix * svg_scaling(state.style.pen.width, state.style.pen.width);
        const auto side = [&](const char* name, double otherwise) {
            return node.attribute(name) ? number(node, name, state) : otherwise;
        };
        const SvgViewport port{Vec2(0), {side("markerWidth", 3), side("markerHeight", 3)}};
        const SvgFraming framing = svg_framing(node, port, source_);
        const Vec2 ref(framing.matrix * Vec3(side("refX", 0), side("refY", 0), 1));
        inside.matrix = inside.matrix * svg_translation(-ref.x, -ref.y);
        enter_frame(node, inside, port, overflows(own));
        if (inside.style.visible) children(node, inside, depth + 1);
    }

    /// Elements by their `id`, for `use`.
    void index(const pugi::xml_node& node, int depth = 0) {
        if (depth > kDeepest) return;  // `walk` will say so
        if (const auto id = node.attribute("id")) by_id_.emplace(id.value(), node);
        for (const pugi::xml_node& child : node.children())
            if (child.type() == pugi::node_element) index(child, depth + 1);
    }

    /// Rules of all style sheets of the file.
    void read_sheets(const pugi::xml_node& node, int depth) {
        if (depth > kDeepest) throw Error(source_, "groups are nested too deeply");
        for (const pugi::xml_node& child : node.children()) {
            if (child.type() != pugi::node_element) continue;
            if (local_name(child) != "style") {
                read_sheets(child, depth + 1);
                continue;
            }
            std::string sheet;
            for (const pugi::xml_node& text : child.children()) sheet += text.value();
            for (std::size_t passed = sheet_.add(sheet); passed > 0; --passed) scene_.losses.add(SvgLoss::rule);
        }
    }

    double number(const pugi::xml_node& node, const char* name, const State& state) const {
        return svg_number(node, name, state.page, source_);
    }
    SvgCurves curves(const SvgMatrix& matrix) const {
        return {.growth = svg_growth(matrix), .tolerance = options_.tolerance};
    }

    const std::string& source_;
    const SvgSceneOptions& options_;
    SvgScene scene_;
    SvgSheet sheet_;
    SvgIds by_id_;
    SvgFonts fonts_;
    SvgPictures pictures_;
    std::size_t n_elements_ = 0, n_points_ = 0, n_text_ = 0, n_matches_ = 0, n_upright_ = 0, n_films_ = 0;
};

}  // namespace

SvgScene read_svg_scene(const pugi::xml_node& svg, const std::string& source, const SvgSceneOptions& options) {
    return SceneReader(source, options).read(svg);
}

}  // namespace tuft::io
