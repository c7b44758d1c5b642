#include <Eigen/Dense>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainiksolverpos_lma.hpp>
#include <kdl/chainjnttojacsolver.hpp>
#include <numbers>
#include <regex>

#include "program.h"

/// Programs for a robot, read by a reader of their own and followed by the joints of an arm (Orocos KDL 1.5).
namespace tuft::test {
namespace {

using std::numbers::pi;

/// UR5e (Universal Robots, "DH parameters for calculations of kinematics and dynamics"): metres, radians.
KDL::Chain ur5e() {
    KDL::Chain chain;
    const struct {
        double a, alpha, d;
    } rows[] = {{0, pi / 2, 0.1625}, {-0.425, 0, 0},       {-0.3922, 0, 0},
                {0, pi / 2, 0.1333}, {0, -pi / 2, 0.0997}, {0, 0, 0.0996}};
    for (const auto& row : rows)
        chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::RotZ), KDL::Frame::DH(row.a, row.alpha, row.d, 0)));
    return chain;
}

KDL::Frame frame_of(const std::string& numbers) {
    static const std::regex number(R"([-+0-9.eE]+)");
    std::vector<double> v;
    for (std::sregex_iterator it(numbers.begin(), numbers.end(), number), end; it != end; ++it)
        v.push_back(std::stod(it->str()));
    EXPECT_EQ(v.size(), 6u) << numbers;
    const KDL::Vector axis(v[3], v[4], v[5]);
    return {KDL::Rotation::Rot(axis, axis.Norm()), KDL::Vector(v[0], v[1], v[2])};
}

/// The poses of the flange that a program in URScript moves through.
std::vector<KDL::Frame> flange_path(const std::string& program) {
    static const std::regex pose(R"((set_tcp|movej|movep|movel)\(p\[([^\]]*)\])");
    std::vector<KDL::Frame> path;
    KDL::Frame tool;
    for (std::sregex_iterator it(program.begin(), program.end(), pose), end; it != end; ++it)
        if ((*it)[1] == "set_tcp")
            tool = frame_of((*it)[2]);
        else
            path.push_back(frame_of((*it)[2]) * tool.Inverse());
    return path;
}

/// How an arm follows a path from one of its postures.
struct Followed {
    bool reached = true;
    double largest_step = 0;     // radians of a joint between two points
    double least_dexterity = 1;  // smallest singular value of the Jacobian; radians, metres
    double farthest = 0;         // radians of a joint from 0
    double error = 0;            // metres and radians between a pose and that of the joints
};

Followed follow(const KDL::Chain& chain, const std::vector<KDL::Frame>& path, KDL::JntArray joints) {
    KDL::ChainIkSolverPos_LMA inverse(chain, 1e-8, 500, 1e-14);
    KDL::ChainFkSolverPos_recursive forward(chain);
    KDL::ChainJntToJacSolver jacobians(chain);
    Followed out;
    for (std::size_t i = 0; i < path.size(); ++i) {
        KDL::JntArray next(6);
        out.reached = inverse.CartToJnt(joints, path[i], next) >= 0;
        if (!out.reached) return out;
        if (i > 0) out.largest_step = std::max(out.largest_step, (next.data - joints.data).cwiseAbs().maxCoeff());
        out.farthest = std::max(out.farthest, next.data.cwiseAbs().maxCoeff());
        joints = next;
        KDL::Jacobian jacobian(6);
        jacobians.JntToJac(joints, jacobian);
        const Eigen::JacobiSVD<Eigen::MatrixXd> svd(jacobian.data);
        out.least_dexterity = std::min(out.least_dexterity, svd.singularValues()[5]);
        KDL::Frame is;
        forward.JntToCart(joints, is);
        const KDL::Twist off = KDL::diff(path[i], is);
        out.error = std::max({out.error, off.vel.Norm(), off.rot.Norm()});
    }
    return out;
}

class JointPath : public Program {};

// Writing inside the bowl, which stands 450 mm before the arm. A step of the path is a few millimetres, 0.2 rad of a
// joint at most where the arm is not near a singularity; at one the smallest singular value is 0 and steps reach pi.
TEST_F(JointPath, ASixAxisArmWritesInsideTheBowl) {
    ASSERT_EQ(tuft("paint " + model("bowl.ply") + " --strokes " + source_folder() +
                   "/samples/strokes/qi-shang-ba-xia.inkml --atlas-size 512 --quiet --project " + path("p.tuft"))
                  .status,
              0);
    const Ran ran =
        tuft("trajectory " + path("p.tuft") + " -o " + path("p.urscript") + " --base 450,0,0,0,0,0 --quiet");
    ASSERT_EQ(ran.status, 0) << ran.err;
    const std::vector<KDL::Frame> flange = flange_path(read(path("p.urscript")));
    ASSERT_GT(flange.size(), 500u);
    Followed best{.reached = false, .least_dexterity = 0};
    // Elbow up and wrist down, in the two ways that the wrist can be turned.
    for (const double turn : {-pi / 2, pi / 2}) {
        KDL::JntArray start(6);
        start.data << 0, -pi / 2, pi / 2, -pi / 2, turn, 0;
        const Followed followed = follow(ur5e(), flange, start);
        if (followed.reached && followed.least_dexterity > best.least_dexterity) best = followed;
    }
    ASSERT_TRUE(best.reached);
    EXPECT_LT(best.error, 1e-6);
    EXPECT_GT(best.least_dexterity, 0.02);
    EXPECT_LT(best.largest_step, 0.5);
    EXPECT_LT(best.farthest, 2 * pi) << "the arm's range";
    RecordProperty("least_dexterity", std::to_string(best.least_dexterity));
    RecordProperty("largest_step", std::to_string(best.largest_step));
}

}  // namespace
}  // namespace tuft::test
