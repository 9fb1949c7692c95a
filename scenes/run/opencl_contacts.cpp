// SPDX-License-Identifier: MIT
#include "run/opencl_contacts.hpp"

#include "pipeline/geometry.hpp"
#include "pipeline/surface.hpp"
#include "run/check_opencl.hpp"
#include "run/opencl_program.hpp"

#include <sstream>
#include <string>
#include <vector>

namespace apsl::scenes {
namespace {

struct ContactCollider {  // as in fill_contacts.cl
    cl_float place[3], reach, axis[3];
    cl_uint is_plane;
    cl_float turning[9], drift[3], friction;
    cl_uint padding[3];
};

// The constants of contacts() for its kernel.
std::string definitions() {
    std::ostringstream text;
    text << std::scientific << " -DSAME_SIDE=" << same_side << "f -DTOUCHING=" << touching
         << "f -DMOST_TRACED=" << most_traced << " -DSTART_DEPTH=" << start_depth
         << "f -DTIME_TO_LEAVE=" << time_to_leave << 'f';
    return text.str();
}

// `place`, `axis` and reach of a shape, as the kernel has them.
struct Form {
    std::array<double, 3> place, axis{};
    double reach;
    bool is_plane = false;
};

Form form_of(const Sphere& sphere) {
    return {.place = sphere.center, .reach = sphere.radius + sphere.contact.thickness};
}

Form form_of(const Plane& plane) {
    const Eigen::Vector3d normal = Eigen::Vector3d(plane.normal.data()).stableNormalized();
    return {.place = plane.point,
            .axis = {normal.x(), normal.y(), normal.z()},
            .reach = plane.contact.thickness,
            .is_plane = true};
}

Form form_of(const Capsule& capsule) {
    Form form{.place = capsule.a, .reach = capsule.radius + capsule.contact.thickness};
    for (std::size_t k = 0; k < 3; ++k) form.axis[k] = capsule.b[k] - capsule.a[k];
    return form;
}

ContactCollider around(const std::array<double, 3>& origin, const ColliderStep& collider) {
    const Form form = std::visit([](const auto& shape) { return form_of(shape); }, collider.shape);
    ContactCollider packed{};
    for (std::size_t k = 0; k < 3; ++k) {
        packed.place[k] = static_cast<float>(form.place[k] - origin[k]);
        packed.axis[k] = static_cast<float>(form.axis[k]);
        double drift = collider.drift[k];
        for (std::size_t n = 0; n < 3; ++n) {
            packed.turning[3 * k + n] = static_cast<float>(collider.turning[3 * k + n]);
            drift += collider.turning[3 * k + n] * origin[n];
        }
        packed.drift[k] = static_cast<float>(drift);
    }
    packed.reach = static_cast<float>(form.reach);
    packed.is_plane = form.is_plane ? 1 : 0;
    packed.friction =
        static_cast<float>(std::visit([](const auto& shape) { return shape.contact.friction; }, collider.shape));
    return packed;
}

}  // namespace

OpenClContacts::OpenClContacts(OpenClCloth& cloth, std::size_t vertices, std::size_t colliders)
    : vertices_(vertices), kernel_(make_kernel(cloth.context(), cloth.device(), "fill_contacts", definitions())) {
    const std::vector<ContactCollider> no_colliders(colliders);
    const std::vector<float> no_contacts(contact_numbers * vertices);
    colliders_ = cloth.make_buffer(std::as_bytes(std::span(no_colliders)), "colliders");
    records_ = cloth.make_buffer(std::as_bytes(std::span(no_contacts)), "contacts");
}

void OpenClContacts::fill(OpenClCloth& cloth, std::span<const ColliderStep> colliders, const FreeFlight& flight,
                          double time_step, const std::array<double, 3>& origin) {
    std::vector<ContactCollider> packed;
    for (const ColliderStep& collider : colliders) packed.push_back(around(origin, collider));
    check_opencl(clEnqueueWriteBuffer(cloth.queue(), colliders_.get(), CL_TRUE, 0,
                                      packed.size() * sizeof(ContactCollider), packed.data(), 0, nullptr, nullptr),
                 "uploading colliders");
    cl_uint argument = 0;
    const auto set = [&](const auto& value) {
        check_opencl(clSetKernelArg(kernel_.get(), argument++, sizeof value, &value), "clSetKernelArg");
    };
    set(static_cast<cl_uint>(vertices_));
    set(static_cast<cl_uint>(packed.size()));
    set(static_cast<cl_float>(time_step));
    set(static_cast<cl_float>(flight.seconds));
    for (const double shift : flight.shift) set(static_cast<cl_float>(shift));
    for (const cl_mem buffer :
         {colliders_.get(), cloth.inverse_masses(), cloth.positions(), cloth.velocities(), records_.get()})
        set(buffer);
    cloth.launch(kernel_.get(), "fill_contacts", vertices_);
}

}  // namespace apsl::scenes
