#include "lab/trace/rigid_shapes.h"

#include "base/error.h"
#include "lab/trace/embree.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sparselens::lab {

namespace {

constexpr std::size_t packet_size = 16;

struct Release {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using Device = std::unique_ptr<RTCDeviceTy, Release>;
using EmbreeScene = std::unique_ptr<RTCSceneTy, Release>;

// The plane of a quad, or the sphere, from which the exact hit is computed.
struct Shape {
    Imath::V3d point;  // a corner; the centre
    Imath::V3d normal; // of the quad
    double radius;     // 0: a quad
    Material material;
};

Shape shape_of(const Quad &quad) {
    const auto &c = quad.corners;
    return {c[0], ((c[2] - c[0]) % (c[3] - c[1])).normalized(), 0, quad.material};
}

// The hit of a ray that Embree says meets the shape; t = inf if that was only rounding.
Hit solve(const Shape &shape, int primitive, const Ray &ray) {
    Hit hit;
    hit.primitive = primitive;
    hit.time = ray.time;
    const Imath::V3d to_shape = shape.point - ray.origin;
    if (shape.radius == 0) {
        hit.t = (to_shape ^ shape.normal) / (ray.direction ^ shape.normal);
        hit.position = hit.at_rest = ray.origin + hit.t * ray.direction;
        hit.normal = shape.normal;
        return hit;
    }
    // Solved from the point of the ray nearest to the centre, which avoids a difference of large squares.
    const double inverse_length2 = 1 / ray.direction.length2();
    const double t_middle = (to_shape ^ ray.direction) * inverse_length2;
    const double distance2 = (to_shape - t_middle * ray.direction).length2();
    const double half_chord2 = std::max(0.0, shape.radius * shape.radius - distance2);
    const double side =
        to_shape.length2() < shape.radius * shape.radius ? -1 : 1; // if the ray starts inside: -1, outside: 1
    hit.t = t_middle - side * std::sqrt(half_chord2 * inverse_length2);
    hit.position = hit.at_rest = ray.origin + hit.t * ray.direction;
    hit.normal = (hit.position - shape.point) * (side / shape.radius);
    return hit;
}

void add_quads(RTCDevice device, RTCScene scene, const std::vector<Quad> &quads) {
    if (quads.empty()) return;
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_QUAD);
    auto *corners = static_cast<float *>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), 4 * quads.size()));
    auto *indices = static_cast<unsigned *>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4, 4 * sizeof(unsigned), quads.size()));
    for (const Quad &quad : quads)
        for (const Imath::V3d &corner : quad.corners)
            for (int axis = 0; axis < 3; ++axis) *corners++ = float(corner[axis]);
    for (unsigned i = 0; i < 4 * quads.size(); ++i) indices[i] = i;
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, 0);
    rtcReleaseGeometry(geometry);
}

void add_spheres(RTCDevice device, RTCScene scene, const std::vector<Sphere> &spheres) {
    if (spheres.empty()) return;
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
    auto *values = static_cast<float *>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 4 * sizeof(float), spheres.size()));
    for (const Sphere &sphere : spheres) {
        for (int axis = 0; axis < 3; ++axis) *values++ = float(sphere.centre[axis]);
        *values++ = float(sphere.radius);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, 1);
    rtcReleaseGeometry(geometry);
}

// `valid` disables lanes past the end of `rays`.
template <typename RayN>
void load(std::span<const Ray> rays, float reach, RayN &packet, int *valid) {
    for (std::size_t i = 0; i < packet_size; ++i) {
        valid[i] = i < rays.size() ? -1 : 0;
        const Ray &ray = rays[i < rays.size() ? i : 0];
        packet.org_x[i] = float(ray.origin.x);
        packet.org_y[i] = float(ray.origin.y);
        packet.org_z[i] = float(ray.origin.z);
        packet.dir_x[i] = float(ray.direction.x);
        packet.dir_y[i] = float(ray.direction.y);
        packet.dir_z[i] = float(ray.direction.z);
        packet.tnear[i] = 0;
        packet.tfar[i] = reach;
        packet.time[i] = 0;
        packet.mask[i] = ~0u;
        packet.id[i] = unsigned(i);
        packet.flags[i] = 0;
    }
}

struct CollectContext {
    QueryContext embree; // first, so that the filter finds the rest behind it
    const std::vector<Shape> *shapes;
    unsigned quads;
    const Ray *ray;
    std::vector<Hit> *hits;
};

// Records the hit and rejects it, so that the search continues.
void collect(const RTCFilterFunctionNArguments *args) {
    auto &context = *reinterpret_cast<CollectContext *>(args->context);
    const unsigned geometry = RTCHitN_geomID(args->hit, args->N, 0);
    const unsigned primitive = RTCHitN_primID(args->hit, args->N, 0) + (geometry == 0 ? 0 : context.quads);
    context.hits->push_back(solve((*context.shapes)[primitive], int(primitive), *context.ray));
    args->valid[0] = 0;
}

} // namespace

struct RigidShapes::Impl {
    std::vector<Shape> shapes; // quads, then spheres
    unsigned quads;
    Device device;
    EmbreeScene embree;
};

RigidShapes::RigidShapes(const std::vector<Quad> &quads, const std::vector<Sphere> &spheres)
    : impl_(std::make_unique<Impl>()) {
    for (const Quad &quad : quads) impl_->shapes.push_back(shape_of(quad));
    for (const Sphere &sphere : spheres)
        impl_->shapes.push_back({sphere.centre, {}, sphere.radius, sphere.material});
    impl_->quads = unsigned(quads.size());
    impl_->device.reset(rtcNewDevice(nullptr));
    if (!impl_->device)
        throw Error(fmt::format("Embree cannot be started: error {}", int(rtcGetDeviceError(nullptr))));
    impl_->embree.reset(rtcNewScene(impl_->device.get()));
    rtcSetSceneFlags(impl_->embree.get(), RTCSceneFlags(RTC_SCENE_FLAG_ROBUST | filtered_scene));
    add_quads(impl_->device.get(), impl_->embree.get(), quads);
    add_spheres(impl_->device.get(), impl_->embree.get(), spheres);
    rtcCommitScene(impl_->embree.get());
    const RTCError error = rtcGetDeviceError(impl_->device.get());
    if (error != RTC_ERROR_NONE) throw Error(fmt::format("Embree refuses the scene: error {}", int(error)));
}

RigidShapes::~RigidShapes() = default;
RigidShapes::RigidShapes(RigidShapes &&) noexcept = default;
RigidShapes &RigidShapes::operator=(RigidShapes &&) noexcept = default;

int RigidShapes::count() const { return int(impl_->shapes.size()); }

Material RigidShapes::material(int primitive) const { return impl_->shapes[std::size_t(primitive)].material; }

void RigidShapes::nearest(std::span<const Ray> rays, std::span<Hit> hits) const {
    for (std::size_t first = 0; first < rays.size(); first += packet_size) {
        const auto some = rays.subspan(first, std::min(packet_size, rays.size() - first));
        alignas(64) int valid[packet_size];
        RTCRayHit16 packet;
        load(some, std::numeric_limits<float>::infinity(), packet.ray, valid);
        for (unsigned &id : packet.hit.geomID) id = RTC_INVALID_GEOMETRY_ID;
        for (unsigned &id : packet.hit.instID[0]) id = RTC_INVALID_GEOMETRY_ID;
        intersect_coherent(valid, impl_->embree.get(), packet);
        for (std::size_t i = 0; i < some.size(); ++i) {
            const unsigned geometry = packet.hit.geomID[i];
            if (geometry == RTC_INVALID_GEOMETRY_ID) {
                hits[first + i] = Hit{};
                continue;
            }
            const unsigned primitive = packet.hit.primID[i] + (geometry == 0 ? 0 : impl_->quads);
            hits[first + i] = solve(impl_->shapes[primitive], int(primitive), some[i]);
        }
    }
}

void RigidShapes::blocked(std::span<const Ray> rays, std::span<bool> blocked) const {
    for (std::size_t first = 0; first < rays.size(); first += packet_size) {
        const auto some = rays.subspan(first, std::min(packet_size, rays.size() - first));
        alignas(64) int valid[packet_size];
        RTCRay16 packet;
        load(some, 1, packet, valid);
        find_occluded(valid, impl_->embree.get(), packet);
        for (std::size_t i = 0; i < some.size(); ++i) blocked[first + i] = packet.tfar[i] < 0;
    }
}

void RigidShapes::add_all(const Ray &ray, std::vector<Hit> &hits) const {
    CollectContext context;
    init_context(context.embree);
    context.shapes = &impl_->shapes;
    context.quads = impl_->quads;
    context.ray = &ray;
    context.hits = &hits;
    RTCRayHit single{};
    single.ray.org_x = float(ray.origin.x);
    single.ray.org_y = float(ray.origin.y);
    single.ray.org_z = float(ray.origin.z);
    single.ray.dir_x = float(ray.direction.x);
    single.ray.dir_y = float(ray.direction.y);
    single.ray.dir_z = float(ray.direction.z);
    single.ray.tfar = std::numeric_limits<float>::infinity();
    single.ray.mask = ~0u;
    single.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    single.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    intersect_filtered(impl_->embree.get(), context.embree, collect, single);
}

} // namespace sparselens::lab
