#include "cli/commands/placing_guide.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "cli/steps/picture_overlay.h"
#include "core/error.h"
#include "core/files/files.h"
#include "core/text/units.h"
#include "io/export/export.h"
#include "pictures/picture_look.h"
#include "render/brush/brush_canvas.h"
#include "render/picture/glass.h"

namespace fs = std::filesystem;

namespace tuft::cli {
namespace {

constexpr int kWidth = 960, kHeight = 720;  // pixels
constexpr double kSpacing = 1e-3;           // metres between points of a line on the model
constexpr double kBridged = 0.08;           // metres that a line may leave its panel for
constexpr double kFills = 0.34;             // of a picture's side by a square piece: the rest shows where it is
constexpr double kMostFilled = 0.85;        // of a picture's side by a long one
constexpr double kLeastView = 0.03;         // metres
constexpr double kSteepest = 80;            // degrees of elevation
constexpr double kFromAbove = 58;           // degrees of elevation, into a bowl
constexpr double kHardlyMore = 1.05;        // what another view of all pieces must show over the one before
constexpr int kEdgeSamples = 4;             // rays per pixel on edges: a quarter of a product picture's
constexpr int kLightStep = 8;               // pixels between samples of light
constexpr double kLevelArrow = 0.4;         // rise of an arrow over its length below which it points to the back

/// A piece on the model.
struct PlacedPiece {
    int number = 0;
    std::vector<SurfacePath> outline;
    SurfacePath arrow;
    Vec3 centre{0}, normal{0, 0, 1};  // where number and arrow are
    Vec3 middle{0};                   // of the box round it
    double size = 0;                  // metres, of the box round it
};

class PieceOnModel {
  public:
    PieceOnModel(const mesh::SurfaceQuery& query, const decal::SurfaceLocator& surface)
        : query_(query), mesh_(query.mesh()), surface_(surface) {}

    /// The points of a line of the panel's plane, in parts where it leaves the surface for long. Where it leaves the
    /// panel for a little, on a bend whose film ends before the cut line does, it goes straight over the model.
    std::vector<SurfacePath> lift(const std::vector<Vec2>& line) const {
        std::vector<SurfacePath> paths(1);
        double off = 0;  // metres since the line left the panel
        for (std::size_t i = 0; i + 1 < line.size(); ++i) {
            const double length = glm::length(line[i + 1] - line[i]);
            const int n = std::max(1, static_cast<int>(std::ceil(length / kSpacing)));
            for (int k = i == 0 ? 0 : 1; k <= n; ++k) {
                const auto at = surface_.locate(line[i] + (static_cast<double>(k) / n) * (line[i + 1] - line[i]));
                if (!at) {
                    off += length / n;
                    continue;
                }
                const Vec3 point = decal::point_at(mesh_, at->triangle, at->weights);
                if (off > 0 && !paths.back().points.empty()) {
                    if (off < kBridged)
                        bridge(paths.back(), point);
                    else
                        paths.emplace_back();
                }
                off = 0;
                paths.back().points.push_back(point);
                paths.back().normals.push_back(mesh::face_normal(mesh_, at->triangle));
            }
        }
        std::erase_if(paths, [](const SurfacePath& path) { return path.points.size() < 2; });
        return paths;
    }

  private:
    void bridge(SurfacePath& path, const Vec3& to) const {
        const Vec3 from = path.points.back();
        const int n = static_cast<int>(std::ceil(glm::length(to - from) / kSpacing));
        for (int k = 1; k < n; ++k)
            if (const auto on = query_.closest_point(from + (static_cast<double>(k) / n) * (to - from))) {
                path.points.push_back(on->position);
                path.normals.push_back(mesh::face_normal(mesh_, on->triangle));
            }
    }

    const mesh::SurfaceQuery& query_;
    const mesh::TriangleMesh& mesh_;
    const decal::SurfaceLocator& surface_;
};

/// The panel's point from which the arrow starts: that of its own triangles nearest to the middle of the film.
Vec2 middle_of(const decal::PrintSurface& surface, const decal::Region& film) {
    const decal::Box2 box = decal::box_of(film);
    const Vec2 middle = 0.5 * (box.lo + box.hi);
    Vec2 best = middle;
    double least = 1e300;
    for (std::size_t t = 0; t < surface.n_own; ++t) {
        Vec2 c(0);
        for (const std::uint32_t v : surface.faces[t]) c += surface.flat[v] / 3.0;
        const double d = glm::length(c - middle);
        if (d < least && decal::contains(film, c)) least = d, best = c;
    }
    return best;
}

PlacedPiece place_on_model(const mesh::SurfaceQuery& query, const decal::PrintSurface& surface,
                           const decal::SurfaceLocator& locator, const decal::Piece& piece) {
    const mesh::TriangleMesh& mesh = query.mesh();
    const PieceOnModel on(query, locator);
    PlacedPiece placed;
    placed.number = piece.number;
    Box box;
    for (decal::Ring ring : piece.film) {
        // From a point on the panel, so that no gap lies across its ends.
        const auto first = std::ranges::find_if(ring, [&](const Vec2& p) { return locator.locate(p).has_value(); });
        if (first != ring.end()) std::rotate(ring.begin(), first, ring.end());
        ring.push_back(ring.front());
        for (SurfacePath& path : on.lift(ring)) {
            for (const Vec3& p : path.points) box.add(p);
            placed.outline.push_back(std::move(path));
        }
    }
    const Vec2 middle = middle_of(surface, piece.film);
    const Vec2 size = decal::box_of(piece.film).size();
    placed.size = glm::length(size);
    if (const auto at = locator.locate(middle)) {
        placed.centre = decal::point_at(mesh, at->triangle, at->weights);
        placed.normal = mesh::face_normal(mesh, at->triangle);
    }
    placed.middle = placed.centre;
    const auto arrow = on.lift({middle, middle + 0.18 * std::min(size.x, size.y) * piece.up});
    if (!arrow.empty()) placed.arrow = arrow[0];
    if (!box.empty()) {
        placed.size = std::max(box.diagonal(), 1e-3);
        placed.middle = box.centre();
        Vec3 mean(0);
        for (const SurfacePath& path : placed.outline)
            for (const Vec3& n : path.normals) mean += n;
        if (glm::length(mean) > 0 && glm::dot(glm::normalize(mean), placed.normal) > 0)
            placed.normal = glm::normalize(glm::normalize(mean) + placed.normal);
    }
    return placed;
}

/// Width and height of a piece over those of a picture.
Vec2 size_in_picture(const PlacedPiece& piece, const render::Camera& camera) {
    Vec2 lo(1e9), hi(-1e9);
    for (const SurfacePath& path : piece.outline)
        for (const Vec3& p : path.points)
            if (const auto at = render::project(camera, p)) lo = glm::min(lo, Vec2(*at)), hi = glm::max(hi, Vec2(*at));
    return glm::max(hi - lo, Vec2(0)) / Vec2(kWidth, kHeight);
}

/// The view straight onto a piece, as far as the camera goes; on level ones from the front.
View view_of(const PlacedPiece& piece, const mesh::TriangleMesh& mesh) {
    View view;
    view.width = kWidth;
    view.height = kHeight;
    const double level = std::hypot(piece.normal.x, piece.normal.y);
    // An arrow to the back of the model points up in a picture from the front.
    bool to_back = level < 0.2;
    if (piece.arrow.points.size() > 1) {
        const Vec3 arrow = piece.arrow.points.back() - piece.arrow.points.front();
        to_back |= std::abs(arrow.z) < kLevelArrow * glm::length(arrow);
    }
    view.elevation = std::clamp(std::atan2(piece.normal.z, level) / kDegree, -kSteepest, kSteepest);
    view.azimuth = to_back ? 0 : std::atan2(piece.normal.x, -piece.normal.y) / kDegree;
    const Vec3 target = piece.middle / kMillimetre;
    view.target_mm = {target.x, target.y, target.z};
    // A first picture's camera says how large the piece is in one.
    view.zoom = mesh.bounds.diagonal() / std::max(2 * piece.size, kLeastView);
    const double closest = mesh.bounds.diagonal() / kLeastView;
    const Vec2 size = size_in_picture(piece, camera_of(view, mesh));
    if (size.x > 0 && size.y > 0)
        view.zoom *= std::min({kFills / std::sqrt(size.x * size.y), kMostFilled / size.x, kMostFilled / size.y});
    view.zoom = std::min(view.zoom, closest);
    return view;
}

/// The part of a piece's cut line that a picture shows.
double seen_part(const PlacedPiece& piece, const PictureOverlay& overlay) {
    double seen = 0, all = 0;
    for (const SurfacePath& path : piece.outline)
        for (std::size_t i = 0; i < path.points.size(); ++i) {
            seen += overlay.shows(path.points[i], path.normals[i]) ? 1 : 0;
            all += 1;
        }
    return all > 0 ? seen / all : 0;
}

/// The view that shows most of the pieces: the usual one where others show hardly more.
View view_of_all(const std::vector<PlacedPiece>& pieces, const stroke::Model& model) {
    View best;
    double most = -1;
    for (const double elevation : {View().elevation, kFromAbove, -View().elevation})
        for (const double turn : {0, 90, 180, 270}) {
            View view;
            view.width = kWidth;
            view.height = kHeight;
            view.azimuth += turn;
            view.elevation = elevation;
            const render::Camera camera = camera_of(view, *model.mesh);
            const PictureOverlay overlay({.width = 1, .height = 1, .rgb = {0, 0, 0}}, camera, *model.query);
            double seen = 0;
            for (const PlacedPiece& piece : pieces) seen += seen_part(piece, overlay);
            if (seen <= kHardlyMore * most) continue;
            most = seen;
            best = view;
        }
    return best;
}

const Vec3 kOwn = render::linear_colour(210, 0, 140), kOther = render::linear_colour(90, 110, 140);

/// Draws the pictures of a guide, with one composition of the paint and one solution of the light for all.
class GuidePictures {
  public:
    GuidePictures(const GuideRequest& request, const std::vector<PlacedPiece>& pieces, const View& first,
                  Console& console)
        : model_(request.project.model),
          pieces_(pieces),
          surface_(request.painting.parts().surface()),
          view_(picture_view(first, *model_.mesh)),
          look_(pictures::make_look(model_, &request.painting, "", false)),
          series_(*model_.mesh, *surface_, look_.appearance, pictures::glass_of(look_, request.painting),
                  series_options(first, console), render::PictureSeries::Length::moving) {}

    /// `number`: of the piece that is shown; 0: all.
    void write(const fs::path& path, int number, const View& view) {
        const render::View next = picture_view(view, *model_.mesh);
        if (!(next == view_)) series_.look_from(view_ = next);
        render::Image image = series_.draw(look_.appearance, look_.transmission.texels);
        PictureOverlay overlay(image, series_.camera(), *model_.query);
        for (const bool own : {false, true})
            for (const PlacedPiece& piece : pieces_)
                if ((number == 0 || piece.number == number) == own) draw_piece(piece, own, number > 0, overlay);
        image.rgb = overlay.rgb();
        write_picture(path, image);
    }

  private:
    render::PictureOptions series_options(const View& first, Console& console) const {
        render::PictureOptions options = picture_options(first, model_);
        options.edge_samples = kEdgeSamples;
        options.light_step = kLightStep;
        options.progress = console.progress();
        return options;
    }

    static void draw_piece(const PlacedPiece& piece, bool own, bool alone, PictureOverlay& overlay) {
        const Vec3 colour = own ? kOwn : kOther;
        for (const SurfacePath& line : piece.outline) overlay.draw(line, own ? 2.5 : 1.5, colour);
        overlay.draw_arrow(piece.arrow, own ? 3 : 1.5, colour);
        overlay.draw_number(piece.number, piece.centre, piece.normal, own && alone ? 30 : 18, colour);
    }

    const stroke::Model& model_;
    const std::vector<PlacedPiece>& pieces_;
    std::shared_ptr<const mesh::SurfaceQuery> surface_;
    render::View view_;  // of the series
    pictures::PictureLook look_;
    render::GlassSeries series_;
};

std::string lines_text(const GuideRequest& request, const std::vector<PlacedPiece>& pieces) {
    const FileFrame& frame = request.project.frame;
    const double unit = metres_per(frame.unit).value_or(kMillimetre);
    std::string text = fmt::format("# cut lines and arrows of a decal sheet on the model, in {}, {} up\n", frame.unit,
                                   frame.y_up ? 'y' : 'z');
    std::size_t next = 1;
    const auto add = [&](const SurfacePath& path) {
        std::string line = "l";
        for (const Vec3& p : path.points) {
            const Vec3 q = (frame.y_up ? Vec3(p.x, p.z, -p.y) : p) / unit;
            text += fmt::format("v {:.6g} {:.6g} {:.6g}\n", q.x, q.y, q.z);
            line += fmt::format(" {}", next++);
        }
        text += line + "\n";
    };
    for (const PlacedPiece& piece : pieces) {
        text += fmt::format("o piece_{}\n", piece.number);
        for (const SurfacePath& path : piece.outline) add(path);
        if (piece.arrow.points.size() < 2) continue;
        text += fmt::format("o piece_{}_up\n", piece.number);
        add(piece.arrow);
    }
    return text;
}

}  // namespace

std::vector<fs::path> write_placing_guide(const fs::path& folder, const GuideRequest& request, Console& console) {
    const mesh::TriangleMesh& mesh = *request.project.model.mesh;
    std::vector<PlacedPiece> pieces;
    std::map<std::size_t, decal::SurfaceLocator> locators;
    for (const decal::Piece& piece : request.sheet.pieces) {
        const decal::PrintSurface& surface = request.sheet.surfaces[piece.surface];
        const auto at = locators.try_emplace(piece.surface, surface).first;
        pieces.push_back(place_on_model(*request.project.model.query, surface, at->second, piece));
    }
    std::error_code ec;
    fs::create_directory(folder, ec);
    if (!fs::is_directory(folder, ec)) throw Error(folder.string(), "the folder cannot be made");
    std::vector<fs::path> files;
    io::write_together(folder / "lines.obj", [&](const fs::path& beside) {
        const std::string text = lines_text(request, pieces);
        write_file(beside / "lines.obj", text.data(), text.size());
        files.push_back(folder / "lines.obj");
        const View all = view_of_all(pieces, request.project.model);
        GuidePictures pictures(request, pieces, all, console);
        pictures.write(beside / "overview.png", 0, all);
        files.push_back(folder / "overview.png");
        for (const PlacedPiece& piece : pieces) {
            const std::string name = fmt::format("piece-{:02}.png", piece.number);
            pictures.write(beside / name, piece.number, view_of(piece, mesh));
            files.push_back(folder / name);
        }
    });
    return files;
}

}  // namespace tuft::cli
