#include "fuzz_paint.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <memory>
#include <vector>

#include "core/random.h"
#include "core/system/parallel.h"
#include "ink/colour/presets.h"
#include "mesh/read/polygon_soup.h"
#include "promise.h"
#include "stroke/document/document.h"

namespace tuft::fuzz {
namespace {

constexpr const char* kInks[] = {"carbon", "cinnabar", "water", "titanium-white-paste"};
constexpr const char* kBrushes[] = {"wolf-small",  "goat-small*0.3", "mixed-small*0.5", "wolf-medium*0.2",
                                    "flat-12*0.3", "filbert-12*0.3", "sword-8*0.3",     "robot-2020"};
// Sizes of what a hand does, metres: a stroke takes a step for each texel of its path.
constexpr double kShort = 1e-3;
constexpr double kReaches[] = {2.5e-4, 2.5e-4, 2.5e-4, 1e-3, 4e-3, 1.5e-2};
constexpr double kSpacings[] = {1, 4, 16, 1000};  // texels

/// What takes as long as tens or hundreds of other inputs: a document measures a brush's tip lag and table anew, a
/// model is made, coupled spines move far. Which inputs do it is said by a hash of all their bytes, so changes of one
/// that did it rarely do it too.
struct Costly {
    bool measured = false;  ///< tip lag, tables
    bool long_path = false;
    bool long_of_wide = false;  ///< as many samples and as much pressure by a wide brush as by a round one
    bool twice = false;         ///< a replay must give the same bits
    bool own_model = false;     ///< one that no other input has
};
Costly costly(std::span<const std::uint8_t> input) {
    std::uint64_t hash = 0xcbf29ce484222325u;  // FNV-1a
    for (const std::uint8_t byte : input) hash = (hash ^ byte) * 0x100000001b3u;
    hash ^= hash >> 32;
    return {.measured = hash % 256 == 1,
            .long_path = hash % 16 == 2,
            .long_of_wide = hash % 16 == 5,
            .twice = hash % 8 == 3,
            .own_model = hash % 256 == 4};
}

/// A tile, a roof, a block or two tiles with a gap, some 20 mm large, each corner moved by up to half of it: in one of
/// eight ways, with `own` in a way of its own.
mesh::PolygonSoup tiny_mesh(Bytes& bytes, bool own) {
    static const std::vector<Vec3> kCorners{{-10, -10, 0}, {10, -10, 0}, {10, 10, 0}, {-10, 10, 0},
                                            {-10, -10, 8}, {10, -10, 8}, {10, 10, 8}, {-10, 10, 8}};
    static const std::vector<std::vector<std::uint32_t>> kFaces[] = {
        {{0, 1, 2, 3}},
        {{0, 1, 2}, {0, 2, 7}, {2, 3, 7}},
        {{3, 2, 1, 0}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}},
        {{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 2, 3}}};
    mesh::PolygonSoup soup;
    const int shape = bytes.below(4), reach = bytes.below(3), variant = bytes.byte();
    Random known(static_cast<std::uint64_t>(variant & 7));
    for (const Vec3& corner : kCorners) {
        Vec3 p = corner;
        if (reach > 0)
            for (int k = 0; k < 3; ++k)
                p[k] += (reach == 1 ? 0.5 : 10) * (own ? bytes.real() : 2 * known.uniform() - 1);
        soup.points.push_back(p);
    }
    soup.polygon_start.push_back(0);
    for (const auto& face : kFaces[shape]) {
        soup.corners.insert(soup.corners.end(), face.begin(), face.end());
        soup.polygon_start.push_back(static_cast<std::uint32_t>(soup.corners.size()));
    }
    return soup;
}

/// Each model is made once, but those of inputs with one of their own. There are at most 136: two sizes of four shapes,
/// as they are or moved in 16 ways.
class Models {
  public:
    /// Returns null for a mesh that is refused. The model holds until the next call.
    const stroke::Model* get(Bytes& bytes, bool own) {
        const std::uint32_t size = 48 + 16 * static_cast<std::uint32_t>(bytes.below(2));
        mesh::PolygonSoup soup = tiny_mesh(bytes, own);
        if (own) return (own_ = make(size, std::move(soup))).get();
        const auto [place, is_new] = made_.try_emplace(key_of(size, soup));
        if (is_new) place->second = make(size, std::move(soup));
        return place->second.get();
    }

  private:
    using Key = std::vector<double>;
    static Key key_of(std::uint32_t size, const mesh::PolygonSoup& soup) {
        Key key{static_cast<double>(size)};
        for (const Vec3& p : soup.points) key.insert(key.end(), {p.x, p.y, p.z});
        key.insert(key.end(), soup.corners.begin(), soup.corners.end());
        return key;
    }
    static std::unique_ptr<const stroke::Model> make(std::uint32_t size, mesh::PolygonSoup soup) {
        stroke::ModelOptions options;
        options.unwrap.size = size;
        options.unwrap.cutting = atlas::Cutting::never;
        std::unique_ptr<const stroke::Model> model;
        refusing(
            [&] { model = std::make_unique<const stroke::Model>(stroke::prepare_model(std::move(soup), options)); });
        return model;
    }

    std::map<Key, std::unique_ptr<const stroke::Model>> made_;
    std::unique_ptr<const stroke::Model> own_;
};

/// In the order of kBrushes, with less hair than they should have, in fewer parts.
const std::vector<brush::Preset>& brushes() {
    static const std::vector<brush::Preset> brushes = [] {
        std::vector<brush::Preset> all;
        for (const char* name : kBrushes) {
            brush::Preset p = brush::load_preset(name);
            p.segments = 4;
            p.bundles = 6;
            p.bristles = 40;
            p.spines = std::min(p.spines, 2);
            all.push_back(p);
        }
        return all;
    }();
    return brushes;
}

/// Gives a painting its brushes and inks, which are read once: a measured pigment takes longer than a stroke.
void use_presets(stroke::Document& painting) {
    for (const brush::Preset& brush : brushes()) painting.use(brush);
    static const std::vector<ink::Ink> inks = [] {
        std::vector<ink::Ink> all;
        for (const char* name : kInks) all.push_back(ink::load_ink(name));
        return all;
    }();
    for (const ink::Ink& ink : inks) painting.use(ink);
}

brush::SpineMethod spine_of(bool other, bool measured, int kind) {
    using brush::SpineMethod;
    static constexpr SpineMethod kOthers[] = {SpineMethod::rod, SpineMethod::macro, SpineMethod::chain,
                                              SpineMethod::truss};
    return !other ? SpineMethod::rod : measured ? SpineMethod::table : kOthers[kind & 3];
}

stroke::PaintStroke stroke_of(Bytes& bytes, const Costly& how) {
    stroke::PaintStroke s;
    const int flags = bytes.byte(), more = bytes.byte(), size = bytes.byte(), kind = bytes.byte();
    const double any_reach = kReaches[size % std::size(kReaches)];
    const int brush = (more & 3) | (kind >> 3 & 4);
    const double reach = how.long_path ? any_reach : std::min(any_reach, kShort);
    // A step of coupled spines takes thirty times as long as one of a round tuft, and a change of pressure as many
    // steps as a path.
    const bool is_small = brushes()[brush].spines > 1 && !how.long_of_wide;
    s.settings.spacing = kSpacings[size >> 6];
    s.settings.spine = spine_of(flags & 1, how.measured, kind);
    s.settings.footprint = flags & 2 ? footprint::Mapping::plane : footprint::Mapping::log;
    s.settings.contact = flags & 4 ? contact::Method::vertices : contact::Method::exact;
    s.settings.dip = flags & 8 ? stroke::DipMode::persistent : stroke::DipMode::each;
    s.settings.film = flags & 16 ? stroke::FilmModel::wet : stroke::FilmModel::still;
    s.settings.smooth = flags & 64 ? 1 : 0;
    s.settings.pressure = flags & 128 ? stroke::PressureFrom::speed_dwell : stroke::PressureFrom::none;
    s.settings.down = Vec3(bytes.real(), bytes.real(), bytes.real());
    s.brush = kBrushes[brush];
    s.layer = kind & 0x40 ? 2 : stroke::kFirstLayer;
    s.mask = kind & 0x80 ? 1 : 0;
    if (size & 32) s.settings.stabilise = reach;
    if (size & 16) s.settings.roll_follow = true, s.settings.roll = bytes.real();
    s.ink = kInks[more >> 2 & 3];
    s.trace.flat = !(more & 16);
    if ((more & 0xe0) == 0xe0) s.tool = stroke::Tool::eraser;
    s.seed = bytes.byte();
    s.settings.compensate_tip_lag = !(flags & 32) && how.measured;
    s.trace.placement.mapping = static_cast<stroke::SurfaceMapping>(bytes.below(3));
    s.trace.placement.origin = 0.02 * Vec3(bytes.real(), bytes.real(), bytes.real());
    if (more & 32) s.trace.placement.right = glm::normalize(Vec3(1, bytes.real(), bytes.real()));
    const int n = 1 + bytes.below(is_small ? 2 : 8);
    double time = 0;
    for (int i = 0; i < n; ++i) {
        stroke::StrokeSample sample;
        sample.time = time += 0.01 * (1 + bytes.real());
        sample.position = reach * Vec3(bytes.real(), bytes.real(), 0);
        sample.pressure = is_small ? 0.1 + 0.05 * bytes.real() : 0.5 + 0.5 * bytes.real();
        if (more & 64) sample.tilt = Vec2(bytes.real(), bytes.real());
        if (!s.trace.flat) {
            sample.position.z = 0.02 + reach * bytes.real();
            const double turn = 40 * reach;  // a radian is as long as the tuft
            sample.rotation = glm::normalize(Quat(1, turn * bytes.real(), turn * bytes.real(), turn * bytes.real()));
        }
        s.trace.samples.push_back(sample);
    }
    return s;
}

stroke::LayerEdit layer_edit_of(Bytes& bytes) {
    stroke::LayerEdit edit{.what = static_cast<stroke::LayerChange>(bytes.below(5))};
    edit.layer = {.id = static_cast<std::uint32_t>(bytes.below(4)),
                  .name = bytes.below(2) ? "a" : "b",
                  .visible = bytes.below(4) > 0,
                  .opacity = std::abs(bytes.real()),
                  .blend = static_cast<ink::Blend>(bytes.below(3))};
    edit.place = static_cast<std::uint32_t>(bytes.below(3));
    edit.other = static_cast<std::uint32_t>(bytes.below(4));
    return edit;
}

stroke::BrushChange brush_change_of(Bytes& bytes, int what) {
    if (what == 0) return stroke::Rinse{};
    if (what == 1) return stroke::Reshape{};
    const double depth = std::abs(bytes.real()), amount = std::abs(bytes.real()), side = bytes.real();
    if (what == 2) return stroke::Dip{.depth = depth, .amount = amount, .side = side};
    return stroke::Wipe{.depth = depth, .amount = amount, .side = side};
}

stroke::JournalEntry entry_of(Bytes& bytes, const Costly& how) {
    const int what = bytes.below(16);
    const stroke::PaintStroke s = stroke_of(bytes, how);
    if (what == 4) return stroke::Dry{.seconds = 0.5 + std::abs(bytes.real()), .down = s.settings.down};
    if (what == 5)
        return stroke::Fill{.ink = s.ink,
                            .layer = s.layer,
                            .mask = s.mask,
                            .film = 2 * std::abs(bytes.real()),
                            .gradient = static_cast<stroke::Gradient>(bytes.below(3)),
                            .to_film = 2 * std::abs(bytes.real()),
                            .to_ink = kInks[s.seed % std::size(kInks)],
                            .from = s.trace.placement.origin,
                            .to = 0.01 * s.settings.down,
                            .region = static_cast<stroke::Region>(bytes.below(3)),
                            .at = s.trace.placement.origin};
    if (what == 6) return layer_edit_of(bytes);
    if (what == 7)
        return stroke::MaskEdit{.mask = {.name = "m", .direction = s.settings.down, .within = 1, .soft = 0.5}};
    if (what > 7) return s;
    return stroke::BrushAction{.what = brush_change_of(bytes, what),
                               .brush = s.brush,
                               .ink = s.ink,
                               .seed = s.seed,
                               .dip = s.settings.dip,
                               .spine = s.settings.spine};
}

void check_ink(const ink::Canvas& canvas) {
    for (std::uint32_t slot = 0; slot < canvas.n_slots(); ++slot)
        for (std::size_t p = 0; p < canvas.pigments().size(); ++p)
            if (const auto* plane = canvas.plane(slot, static_cast<int>(p)))
                for (const float amount : *plane)
                    promise(std::isfinite(amount) && amount >= 0, "ink is finite and not negative");
}

}  // namespace

void run_paint(std::span<const std::uint8_t> input) {
    static Models models;
    if (thread_count() != 1) set_thread_count(1);  // what is so small is made faster by one
    Bytes bytes(input);
    const Costly how = costly(input);
    bytes.byte();  // of older seeds
    refusing([&] {
        const stroke::Model* model = models.get(bytes, how.own_model);
        if (!model) return;
        stroke::Document painting(*model);
        use_presets(painting);
        for (int i = 0; i < 3 && !bytes.empty(); ++i) refusing([&] { painting.paint(entry_of(bytes, how)); });
        check_ink(painting.layers().canvas());
        if (!how.twice) return;
        stroke::Document again(*model);
        use_presets(again);
        again.replay(painting.journal().entries());
        promise(again.layers().hash() == painting.layers().hash(), "a replay gives the same bits");
    });
}

}  // namespace tuft::fuzz
