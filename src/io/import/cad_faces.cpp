#include "io/import/cad_faces.h"

#include <BRepMesh_IncrementalMesh.hxx>
#include <BRep_Tool.hxx>
#include <GeomLib.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <Precision.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_DataMapOfShapeInteger.hxx>
#include <TopTools_ShapeMapHasher.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Vertex.hxx>
#include <cmath>
#include <numeric>

#include "core/text/units.h"

namespace tuft::io {
namespace {

constexpr double kMostTurn = 0.35;  // radians between neighbouring triangles

/// Nodes of all faces of a body; those on shared edges and vertices are joined.
class Nodes {
  public:
    /// Adds n nodes and returns the number of the first.
    std::uint32_t add(std::size_t n) {
        const std::size_t first = root_.size();
        if (first + n >= kNone) throw std::bad_alloc();
        root_.resize(first + n);
        std::iota(root_.begin() + static_cast<std::ptrdiff_t>(first), root_.end(), static_cast<std::uint32_t>(first));
        return static_cast<std::uint32_t>(first);
    }
    std::uint32_t root(std::uint32_t node) {
        while (root_[node] != node) node = root_[node] = root_[root_[node]];
        return node;
    }
    void join(std::uint32_t a, std::uint32_t b) {
        a = root(a), b = root(b);
        root_[std::max(a, b)] = std::min(a, b);
    }

  private:
    std::vector<std::uint32_t> root_;
};

struct MeshedFace {
    TopoDS_Face face;
    Handle(Poly_Triangulation) triangles;
    TopLoc_Location location;
    std::uint32_t first_node = 0, part = 0;
};

class BodyMesh {
  public:
    void add(const MeshedFace& meshed) {
        faces_.push_back(meshed);
        MeshedFace& f = faces_.back();
        f.first_node = nodes_.add(static_cast<std::size_t>(f.triangles->NbNodes()));
        for (TopExp_Explorer at(f.face, TopAbs_EDGE); at.More(); at.Next()) join_edge(f, TopoDS::Edge(at.Current()));
    }

    void write(const gp_Trsf& placement, FileScene& out) {
        for (const MeshedFace& f : faces_) {
            gp_Trsf to_model = placement;
            to_model.Multiply(f.location.Transformation());
            write_points(f, to_model, out);
            write_triangles(f, to_model, out);
        }
    }

  private:
    void join_edge(const MeshedFace& f, const TopoDS_Edge& edge) {
        const Handle(Poly_PolygonOnTriangulation) line =
            BRep_Tool::PolygonOnTriangulation(edge, f.triangles, f.location);
        if (line.IsNull() || line->NbNodes() < 2) return;
        std::vector<std::uint32_t> nodes;
        for (int i = 1; i <= line->NbNodes(); ++i)
            nodes.push_back(f.first_node + static_cast<std::uint32_t>(line->Node(i) - 1));
        const TopoDS_Shape forward = edge.Oriented(TopAbs_FORWARD);
        join_vertex(TopExp::FirstVertex(TopoDS::Edge(forward)), nodes.front());
        join_vertex(TopExp::LastVertex(TopoDS::Edge(forward)), nodes.back());
        if (BRep_Tool::Degenerated(edge))  // a pole or an apex: one place
            for (const std::uint32_t node : nodes) nodes_.join(node, nodes.front());
        if (!edges_.IsBound(forward)) {
            edges_.Bind(forward, static_cast<int>(lines_.size()));
            lines_.push_back(std::move(nodes));
            return;
        }
        const std::vector<std::uint32_t>& other = lines_[static_cast<std::size_t>(edges_.Find(forward))];
        if (other.size() != nodes.size()) return;
        for (std::size_t i = 0; i < nodes.size(); ++i) nodes_.join(nodes[i], other[i]);
    }

    void join_vertex(const TopoDS_Vertex& vertex, std::uint32_t node) {
        if (vertex.IsNull()) return;
        const TopoDS_Shape forward = vertex.Oriented(TopAbs_FORWARD);
        if (vertices_.IsBound(forward))
            nodes_.join(node, static_cast<std::uint32_t>(vertices_.Find(forward)));
        else
            vertices_.Bind(forward, static_cast<int>(node));
    }

    void write_points(const MeshedFace& f, const gp_Trsf& to_model, FileScene& out) {
        for (int i = 1; i <= f.triangles->NbNodes(); ++i) {
            const std::uint32_t node = f.first_node + static_cast<std::uint32_t>(i - 1);
            point_.push_back(static_cast<std::uint32_t>(out.points.size()));
            if (const std::uint32_t root = nodes_.root(node); root != node) {
                point_.back() = point_[root];  // written before: it is the least of its set
                continue;
            }
            const gp_Pnt p = f.triangles->Node(i).Transformed(to_model);
            if (out.points.size() + 1 >= kNone) throw std::bad_alloc();
            out.points.push_back(kMillimetre * Vec3(p.X(), p.Y(), p.Z()));
        }
    }

    void write_triangles(const MeshedFace& f, const gp_Trsf& to_model, FileScene& out) {
        const bool mirrored = to_model.IsNegative(), reversed = f.face.Orientation() == TopAbs_REVERSED;
        TopLoc_Location of_surface;
        const Handle(Geom_Surface) surface = BRep_Tool::Surface(f.face, of_surface);
        gp_Trsf turn = to_model;
        if (!(of_surface == f.location)) {
            turn.Multiply(f.location.Transformation().Inverted());
            turn.Multiply(of_surface.Transformation());
        }
        const auto normal_at = [&](int node) {
            gp_Dir normal;
            if (surface.IsNull() || !f.triangles->HasUVNodes() ||
                GeomLib::NormEstim(surface, f.triangles->UVNode(node), Precision::Confusion(), normal) > 1)
                return Vec3f(NAN);
            gp_XYZ n = turn.VectorialPart() * normal.XYZ();
            n.Normalize();
            if (reversed) n.Reverse();
            return Vec3f(Vec3(n.X(), n.Y(), n.Z()));
        };
        std::vector<Vec3f> normals;
        for (int i = 1; i <= f.triangles->NbNodes(); ++i) normals.push_back(normal_at(i));
        for (int t = 1; t <= f.triangles->NbTriangles(); ++t) {
            std::array<int, 3> n{};
            f.triangles->Triangle(t).Get(n[0], n[1], n[2]);
            if (reversed != mirrored) std::swap(n[1], n[2]);
            std::array<std::uint32_t, 3> corners{};
            std::array<Vec3f, 3> at_corners;
            for (std::size_t k = 0; k < 3; ++k) {
                corners[k] = point_[f.first_node + static_cast<std::uint32_t>(n[k] - 1)];
                at_corners[k] = normals[static_cast<std::size_t>(n[k] - 1)];
            }
            if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
            out.add_polygon(f.part, corners, {});
            out.normals.insert(out.normals.end(), at_corners.begin(), at_corners.end());
        }
    }

    Nodes nodes_;
    std::vector<MeshedFace> faces_;
    TopTools_DataMapOfShapeInteger edges_, vertices_;  ///< index in `lines_`; node
    std::vector<std::vector<std::uint32_t>> lines_;    ///< nodes of an edge in the first face that has it
    std::vector<std::uint32_t> point_;                 ///< by node: index in the scene
};

}  // namespace

void tessellate(const TopoDS_Shape& shape, double chord) {
    IMeshTools_Parameters how;
    how.Deflection = chord;
    how.Angle = kMostTurn;
    how.AllowQualityDecrease = true;  // what the file brings along gives way
    BRepMesh_IncrementalMesh(shape, how);
}

std::size_t add_body(const TopoDS_Shape& body, const gp_Trsf& placement,
                     const std::function<std::uint32_t(const TopoDS_Shape&)>& part_of, FileScene& out) {
    BodyMesh mesh;
    std::size_t bare = 0;
    for (TopExp_Explorer at(body, TopAbs_FACE); at.More(); at.Next()) {
        MeshedFace f{.face = TopoDS::Face(at.Current())};
        f.triangles = BRep_Tool::Triangulation(f.face, f.location);
        if (f.triangles.IsNull() || f.triangles->NbTriangles() == 0) {
            ++bare;
            continue;
        }
        f.part = part_of(f.face);
        mesh.add(f);
    }
    mesh.write(placement, out);
    return bare;
}

}  // namespace tuft::io
