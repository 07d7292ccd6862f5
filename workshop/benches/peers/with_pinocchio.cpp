/* Robots by Pinocchio's articulated body algorithm, with both of its conventions: `NAME` reads
 * place, quaternion (x, y, z, w), angles and velocities, and writes the rates of the velocities; those of the coordinates it leaves alone. The table is that of `bodies/build.rs`. */
#include <fstream>
#include <sstream>
#include <string>

#include <pinocchio/algorithm/aba.hpp>
#include <pinocchio/multibody.hpp>

namespace p = pinocchio;

struct Robot {
    p::Model model;
    p::Data data;
    Eigen::VectorXd q, v, tau;

    explicit Robot(const std::string &name) : model(read(name)), data(model), q(model.nq), v(model.nv), tau(Eigen::VectorXd::Zero(model.nv)) {}

    static p::Model read(const std::string &name) {
        p::Model model;
        std::ifstream file(std::string(ROBOTS) + "/" + name + ".robot");
        std::vector<p::JointIndex> joints;
        for (std::string line; std::getline(file, line);) {
            std::istringstream words(line);
            size_t carrier;
            char axis;
            double mass, xx, yy, zz, xy, yz, xz;
            p::SE3 place = p::SE3::Identity();
            Eigen::Vector3d center;
            words >> carrier >> axis >> place.translation()[0] >> place.translation()[1] >> place.translation()[2];
            words >> mass >> xx >> yy >> zz >> xy >> yz >> xz >> center[0] >> center[1] >> center[2];
            std::string joint = "joint" + std::to_string(joints.size());
            p::JointIndex index = joints.empty() ? model.addJoint(0, p::JointModelFreeFlyer(), place, joint)
                                : axis == 'x'    ? model.addJoint(joints[carrier], p::JointModelRX(), place, joint)
                                : axis == 'y'    ? model.addJoint(joints[carrier], p::JointModelRY(), place, joint)
                                                 : model.addJoint(joints[carrier], p::JointModelRZ(), place, joint);
            joints.push_back(index);
            Eigen::Matrix3d inertia;
            inertia << xx, xy, xz, xy, yy, yz, xz, yz, zz;
            model.appendBodyToJoint(index, p::Inertia(mass, center, inertia));
        }
        return model;
    }

    template <p::Convention convention> void rates(const double *state, double *out) {
        q = Eigen::Map<const Eigen::VectorXd>(state, model.nq);
        v = Eigen::Map<const Eigen::VectorXd>(state + model.nq, model.nv);
        Eigen::Map<Eigen::VectorXd>(out + model.nq, model.nv) = p::aba(model, data, q, v, tau, convention);
    }
};

/* Built on the first call: Pinocchio's own constants, gravity among them, have their values only once all libraries are loaded. */
template <p::Convention convention> static void rates(Robot *&robot, const char *name, const double *state, double *out) {
    if (!robot) robot = new Robot(name);
    robot->rates<convention>(state, out);
}

#define SERVED(name)                                                                                                                             \
    static Robot *name##_robot;                                                                                                                  \
    extern "C" void name##_local(const double *state, double *out) { rates<p::Convention::LOCAL>(name##_robot, #name, state, out); } \
    extern "C" void name##_world(const double *state, double *out) { rates<p::Convention::WORLD>(name##_robot, #name, state, out); }
SERVED(quadruped)
SERVED(humanoid)
