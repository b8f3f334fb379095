// Evaluates the limit surface of a Catmull-Clark mesh at the points of a uniform tessellation with OpenSubdiv 3.5 (Bfr) and
// Embree 3.13, and prints how long positions and normals of all points take.
//
//   apt-get install -y libosd-dev libembree-dev g++
//   g++ -O2 -march=native -std=c++17 -o tessellate tessellate.cpp -losdCPU -lembree3 -pthread
//   ./tessellate FILE.obj [--depths 2,3,4,5,6] [--threads 2] [--times 31]
//
// The points are those of `examples/tessellate_times.rs`: 2^depth segments along every edge of a quad, each point of the surface
// once, whichever faces it belongs to. Both keep whatever does not depend on positions; a time is that of vertices that moved.

#include <embree3/rtcore.h>
#include <opensubdiv/bfr/refinerSurfaceFactory.h>
#include <opensubdiv/far/topologyDescriptor.h>

#include "../control_mesh.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <limits>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

using namespace OpenSubdiv;
using Surface = Bfr::Surface<float>;

char const *const kProgram = "tessellate";

// ---------------------------------------------------------------- points

struct Point {
    int sub;  // of a face that is no quad: the corner whose quarter it is in, else -1
    float u, v;
};

// The points of each face: those on its edges and corners belong to the first face that has them.
struct Points {
    std::vector<size_t> first;
    std::vector<Point> all;
};

Points points_of(Mesh const &mesh, int depth) {
    int const segments = 1 << depth, half = segments / 2;
    std::set<int> corners;
    std::set<std::pair<int, int>> edges;
    Points points;
    size_t start = 0;
    for (int size : mesh.face_sizes) {
        points.first.push_back(points.all.size());
        int const *face = &mesh.face_vertices[start];
        start += size;
        bool const quad = size == 4;
        auto add = [&](int sub, int i, int j) {
            float const n = float(quad ? segments : half);
            points.all.push_back({quad ? -1 : sub, i / n, j / n});
        };
        // Along an edge of a quad, from its first corner on.
        auto on_quad = [&](int k, int t) {
            int const back = segments - t;
            int const places[4][2] = {{t, 0}, {segments, t}, {back, segments}, {0, back}};
            add(-1, places[k][0], places[k][1]);
        };
        for (int k = 0; k < size; ++k) {
            int a = face[k], b = face[(k + 1) % size];
            if (corners.insert(a).second) quad ? on_quad(k, 0) : add(k, 0, 0);
            if (!edges.insert({std::min(a, b), std::max(a, b)}).second) continue;
            for (int t = 1; t < segments; ++t) {
                if (quad) on_quad(k, t);
                else if (t <= half) add(k, t, 0);
                else add((k + 1) % size, 0, segments - t);
            }
        }
        if (quad) {
            for (int j = 1; j < segments; ++j)
                for (int i = 1; i < segments; ++i) add(-1, i, j);
        } else {
            for (int k = 0; k < size; ++k)
                for (int j = 1; j < half; ++j)
                    for (int i = 1; i <= half; ++i) add(k, i, j);
            add(0, half, half);
        }
    }
    points.first.push_back(points.all.size());
    return points;
}

struct Out {
    std::vector<float> positions, normals;
    explicit Out(size_t count) : positions(3 * count), normals(3 * count) {}
};

void write_normal(float const *du, float const *dv, float *normal) {
    float const n[3] = {du[1] * dv[2] - du[2] * dv[1], du[2] * dv[0] - du[0] * dv[2], du[0] * dv[1] - du[1] * dv[0]};
    float const length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int k = 0; k < 3; ++k) normal[k] = length > 0 ? n[k] / length : 0;
}

// Has threads take faces, some at a time.
void in_parallel(int threads, int faces, std::function<void(int, int)> const &work) {
    std::atomic<int> next(0);
    auto run = [&] {
        constexpr int kFaces = 16;
        for (int face; (face = next.fetch_add(kFaces)) < faces;) work(face, std::min(face + kFaces, faces));
    };
    std::vector<std::thread> others;
    for (int i = 1; i < threads; ++i) others.emplace_back(run);
    run();
    for (auto &other : others) other.join();
}

struct Times {
    double setup = 0;
    std::vector<double> moved;
};

void time_moved(Times &times, int count, std::function<void()> const &work) {
    for (int i = 0; i < count; ++i) {
        double start = now_ms();
        work();
        times.moved.push_back(now_ms() - start);
    }
    std::sort(times.moved.begin(), times.moved.end());
}

// ---------------------------------------------------------------- OpenSubdiv

Times with_bfr(Mesh const &mesh, Points const &points, int threads, int count, Out &out) {
    double const start = now_ms();
    Far::TopologyDescriptor desc;
    desc.numVertices = mesh.vertex_count;
    desc.numFaces = int(mesh.face_sizes.size());
    desc.numVertsPerFace = mesh.face_sizes.data();
    desc.vertIndicesPerFace = mesh.face_vertices.data();
    desc.numCreases = int(mesh.crease_weights.size());
    desc.creaseVertexIndexPairs = mesh.crease_pairs.data();
    desc.creaseWeights = mesh.crease_weights.data();
    desc.numCorners = int(mesh.corner_weights.size());
    desc.cornerVertexIndices = mesh.corners.data();
    desc.cornerWeights = mesh.corner_weights.data();
    using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
    Sdc::Options sdc;
    sdc.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
    std::unique_ptr<Far::TopologyRefiner> refiner(Factory::Create(desc, Factory::Options(Sdc::SCHEME_CATMARK, sdc)));
    if (!refiner) fail("OpenSubdiv refused the topology");
    Bfr::RefinerSurfaceFactory<> factory(*refiner);
    int const faces = int(mesh.face_sizes.size());
    std::vector<Surface> surfaces(faces);
    for (int face = 0; face < faces; ++face) factory.InitVertexSurface(face, &surfaces[face]);
    Times times;
    times.setup = now_ms() - start;
    Surface::PointDescriptor const three(3);
    time_moved(times, count, [&] {
        in_parallel(threads, faces, [&](int from, int to) {
            std::vector<float> patch;
            for (int face = from; face < to; ++face) {
                Surface const &surface = surfaces[face];
                if (!surface.IsValid()) continue;
                patch.resize(3 * size_t(surface.GetNumPatchPoints()));
                surface.PreparePatchPoints(mesh.points.data(), three, patch.data(), three);
                auto const parameters = surface.GetParameterization();
                for (size_t i = points.first[face]; i < points.first[face + 1]; ++i) {
                    Point const &point = points.all[i];
                    float uv[2] = {point.u, point.v}, du[3], dv[3];
                    if (point.sub >= 0) {
                        float const own[2] = {point.u, point.v};
                        parameters.ConvertNormalizedSubFaceToCoord(point.sub, own, uv);
                    }
                    surface.Evaluate(uv, patch.data(), three, &out.positions[3 * i], du, dv);
                    write_normal(du, dv, &out.normals[3 * i]);
                }
            }
        });
    });
    return times;
}

// ---------------------------------------------------------------- Embree

Times with_embree(Mesh &mesh, Points const &points, int threads, int count, Out &out, double &commit) {
    double const start = now_ms();
    RTCDevice device = rtcNewDevice(("threads=" + std::to_string(threads)).c_str());
    if (!device) fail("Embree has no device");
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SUBDIVISION);
    auto share = [&](RTCBufferType type, RTCFormat format, void const *data, size_t stride, size_t items) {
        if (items > 0) rtcSetSharedGeometryBuffer(geometry, type, 0, format, data, 0, stride, items);
    };
    std::vector<float> crease_weights = mesh.crease_weights, corner_weights = mesh.corner_weights;
    for (auto *weights : {&crease_weights, &corner_weights})
        for (float &weight : *weights)
            if (weight >= 10) weight = std::numeric_limits<float>::infinity();
    int const faces = int(mesh.face_sizes.size());
    // For loads of 16 bytes.
    mesh.points.resize(3 * size_t(mesh.vertex_count) + 4);
    share(RTC_BUFFER_TYPE_FACE, RTC_FORMAT_UINT, mesh.face_sizes.data(), 4, faces);
    share(RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT, mesh.face_vertices.data(), 4, mesh.face_vertices.size());
    share(RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, mesh.points.data(), 12, mesh.vertex_count);
    share(RTC_BUFFER_TYPE_EDGE_CREASE_INDEX, RTC_FORMAT_UINT2, mesh.crease_pairs.data(), 8, crease_weights.size());
    share(RTC_BUFFER_TYPE_EDGE_CREASE_WEIGHT, RTC_FORMAT_FLOAT, crease_weights.data(), 4, crease_weights.size());
    share(RTC_BUFFER_TYPE_VERTEX_CREASE_INDEX, RTC_FORMAT_UINT, mesh.corners.data(), 4, corner_weights.size());
    share(RTC_BUFFER_TYPE_VERTEX_CREASE_WEIGHT, RTC_FORMAT_FLOAT, corner_weights.data(), 4, corner_weights.size());
    rtcSetGeometrySubdivisionMode(geometry, 0, RTC_SUBDIVISION_MODE_PIN_CORNERS);
    rtcCommitGeometry(geometry);
    RTCScene scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_DYNAMIC);
    rtcAttachGeometry(scene, geometry);
    rtcCommitScene(scene);
    // Faces that are no quads have their quarters side by side.
    std::vector<unsigned> ids(points.all.size());
    std::vector<float> us(ids.size()), vs(ids.size());
    for (int face = 0; face < faces; ++face)
        for (size_t i = points.first[face]; i < points.first[face + 1]; ++i) {
            Point const &point = points.all[i];
            ids[i] = unsigned(face);
            us[i] = point.sub < 0 ? point.u : 2.0f * (point.sub % 4) + 0.5f + point.u;
            vs[i] = point.sub < 0 ? point.v : 2.0f * (point.sub / 4) + 0.5f + point.v;
        }
    Times times;
    times.setup = now_ms() - start;
    time_moved(times, count, [&] {
        in_parallel(threads, faces, [&](int from, int to) {
            constexpr unsigned kPoints = 256;
            // Embree reads and writes whole registers, aligned.
            alignas(64) float p[3 * kPoints], du[3 * kPoints], dv[3 * kPoints], u[kPoints], v[kPoints];
            alignas(64) unsigned faces_of[kPoints];
            for (size_t first = points.first[from]; first < points.first[to]; first += kPoints) {
                unsigned const n = unsigned(std::min<size_t>(kPoints, points.first[to] - first));
                unsigned const padded = (n + 15) / 16 * 16;
                for (unsigned i = 0; i < padded; ++i) {
                    size_t const from = first + std::min(i, n - 1);
                    faces_of[i] = ids[from], u[i] = us[from], v[i] = vs[from];
                }
                RTCInterpolateNArguments arguments = {};
                arguments.geometry = geometry;
                arguments.primIDs = faces_of;
                arguments.u = u;
                arguments.v = v;
                arguments.N = padded;
                arguments.bufferType = RTC_BUFFER_TYPE_VERTEX;
                arguments.P = p;
                arguments.dPdu = du;
                arguments.dPdv = dv;
                arguments.valueCount = 3;
                rtcInterpolateN(&arguments);
                // Each coordinate of all points, then the next.
                for (unsigned i = 0; i < n; ++i) {
                    float const a[3] = {du[i], du[padded + i], du[2 * padded + i]};
                    float const b[3] = {dv[i], dv[padded + i], dv[2 * padded + i]};
                    for (int k = 0; k < 3; ++k) out.positions[3 * (first + i) + k] = p[k * padded + i];
                    write_normal(a, b, &out.normals[3 * (first + i)]);
                }
            }
        });
    });
    // What Embree does besides, when vertices move: its patches and its tree.
    std::vector<double> commits;
    for (int i = 0; i < 7; ++i) {
        double from = now_ms();
        rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0);
        rtcCommitGeometry(geometry);
        rtcCommitScene(scene);
        commits.push_back(now_ms() - from);
    }
    std::sort(commits.begin(), commits.end());
    commit = commits[commits.size() / 2];
    rtcReleaseScene(scene);
    rtcReleaseGeometry(geometry);
    rtcReleaseDevice(device);
    return times;
}

// ---------------------------------------------------------------- both

// The greatest distance of positions, and of normals.
std::pair<double, double> apart(Out const &a, Out const &b) {
    double worst[2] = {0, 0};
    for (size_t i = 0; i < a.positions.size(); i += 3) {
        double p = 0, n = 0;
        for (size_t k = i; k < i + 3; ++k) {
            p += std::pow(double(a.positions[k]) - b.positions[k], 2);
            n += std::pow(double(a.normals[k]) - b.normals[k], 2);
        }
        worst[0] = std::max(worst[0], std::sqrt(p));
        worst[1] = std::max(worst[1], std::sqrt(n));
    }
    return {worst[0], worst[1]};
}

int main(int argc, char **argv) {
    std::string file, depths = "2,3,4,5,6";
    int threads = 2, count = 31;
    for (int i = 1; i < argc; ++i) {
        std::string key = argv[i];
        if (key.rfind("--", 0) != 0) { file = key; continue; }
        if (++i >= argc) fail(key + " needs a value");
        if (key == "--depths") depths = argv[i];
        else if (key == "--threads") threads = std::atoi(argv[i]);
        else if (key == "--times") count = std::atoi(argv[i]);
        else fail("cannot use " + key);
    }
    if (file.empty()) fail("usage: tessellate FILE.obj [--depths 2,3,4,5,6] [--threads 2] [--times 31]");
    Mesh mesh = read_obj(file);
    std::printf("depth    points  bfr ms: set-up  moved   best  embree ms: set-up  moved   best  commit  apart\n");
    std::stringstream list(depths);
    for (std::string depth; std::getline(list, depth, ',');) {
        Points const points = points_of(mesh, std::atoi(depth.c_str()));
        Out bfr(points.all.size()), embree(points.all.size());
        double commit = 0;
        Times const a = with_bfr(mesh, points, threads, count, bfr);
        Times const b = with_embree(mesh, points, threads, count, embree, commit);
        auto const [positions, normals] = apart(bfr, embree);
        std::printf("%5s%10zu%16.1f%7.2f%7.2f%19.1f%7.2f%7.2f%8.2f  %.1e %.1e\n", depth.c_str(), points.all.size(), a.setup,
                    a.moved[a.moved.size() / 2], a.moved[0], b.setup, b.moved[b.moved.size() / 2], b.moved[0], commit,
                    positions, normals);
        std::fflush(stdout);
    }
}
