#include "io/svg/svg_pattern.h"

#include <cmath>
#include <pugixml.hpp>

#include "core/error.h"
#include "io/strokes/inkml_marks.h"

namespace tuft::io {
namespace {

constexpr std::size_t kMostTemplates = 64;
constexpr double kMostTiles = 20'000;

}  // namespace

std::vector<pugi::xml_node> svg_pattern_chain(const std::string& id, const SvgIds& ids) {
    std::vector<pugi::xml_node> chain;
    auto at = ids.find(id);
    while (chain.size() < kMostTemplates && at != ids.end() && local_name(at->second) == "pattern") {
        chain.push_back(at->second);
        const std::string next = svg_href(at->second);
        at = next.size() > 1 ? ids.find(next.substr(1)) : ids.end();
    }
    return chain;
}

std::string svg_chain_text(const std::vector<pugi::xml_node>& chain, const char* name) {
    for (const pugi::xml_node& one : chain)
        if (one.attribute(name)) return one.attribute(name).value();
    return {};
}

std::optional<SvgPatternGrid> svg_pattern_grid(const std::vector<pugi::xml_node>& chain,
                                               const std::pair<Vec2, Vec2>& bounds, const Vec2& page,
                                               const std::string& source) {
    const bool in_box = svg_chain_text(chain, "patternUnits") != "userSpaceOnUse";
    const auto [low, high] = bounds;
    const Vec2 size = high - low, whole = in_box ? Vec2(1) : page;
    const auto number = [&](const char* name, double unit) {
        const std::string text = svg_chain_text(chain, name);
        if (text.empty()) return 0.0;
        SvgReader in(text, source);
        const double value = in.number();
        return in.peek() == '%' ? value / 100 * unit : value;
    };
    SvgPatternGrid grid;
    grid.corner = {number("x", whole.x), number("y", whole.y)};
    grid.tile = {number("width", whole.x), number("height", whole.y)};
    if (in_box) grid.corner = low + grid.corner * size, grid.tile *= size;
    if (!(grid.tile.x > 0 && grid.tile.y > 0) || !(size.x > 0 && size.y > 0)) return std::nullopt;
    if (const std::string text = svg_chain_text(chain, "patternTransform"); !text.empty())
        grid.matrix = svg_transform(text.c_str(), source);
    if (glm::determinant(grid.matrix) == 0) return std::nullopt;
    Vec2 from(HUGE_VAL), to(-HUGE_VAL);
    for (const Vec2& p : {low, high, Vec2(low.x, high.y), Vec2(high.x, low.y)}) {
        const Vec2 q = (Vec2(glm::inverse(grid.matrix) * Vec3(p, 1)) - grid.corner) / grid.tile;
        from = glm::min(from, q), to = glm::max(to, q);
    }
    grid.from = glm::floor(from + 1e-9), grid.to = glm::ceil(to - 1e-9);
    if (!((grid.to.x - grid.from.x) * (grid.to.y - grid.from.y) <= kMostTiles))
        throw Error(source, "a pattern has too many tiles");
    return grid;
}

}  // namespace tuft::io
