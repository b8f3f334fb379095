// The control mesh of an OBJ file, and the clock: what the programs beside have in common.
#pragma once

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

// The program's name, before what it says on the standard error stream.
extern char const *const kProgram;

[[noreturn]] inline void fail(std::string const &what) {
    std::fprintf(stderr, "%s: %s\n", kProgram, what.c_str());
    std::exit(1);
}

inline double now_ms() {
    using namespace std::chrono;
    return duration<double, std::milli>(steady_clock::now().time_since_epoch()).count();
}

struct Mesh {
    std::vector<float> points;  // x y z, and what a program puts behind the last
    std::vector<int> face_sizes, face_vertices, crease_pairs, corners;
    std::vector<float> crease_weights, corner_weights;
    int vertex_count = 0;
};

// Reads v, f and OpenSubdiv's own "t crease 2/1/0 a b sharpness" and "t corner 1/1/0 a sharpness". Other tags are counted
// on standard output.
inline Mesh read_obj(std::string const &path) {
    std::ifstream file(path);
    if (!file) fail("cannot read " + path);
    Mesh mesh;
    std::map<std::string, int> ignored;
    for (std::string line; std::getline(file, line);) {
        std::stringstream words(line);
        std::string kind, word;
        words >> kind;
        if (kind == "v") {
            float x, y, z;
            words >> x >> y >> z;
            mesh.points.insert(mesh.points.end(), {x, y, z});
            ++mesh.vertex_count;
        } else if (kind == "f") {
            int count = 0;
            for (; words >> word; ++count) {
                int index = std::atoi(word.c_str());
                mesh.face_vertices.push_back(index > 0 ? index - 1 : mesh.vertex_count + index);
            }
            mesh.face_sizes.push_back(count);
        } else if (kind == "t") {
            std::string tag, counts;
            words >> tag >> counts;
            int a, b;
            float sharpness;
            if (tag == "crease" && words >> a >> b >> sharpness) {
                mesh.crease_pairs.insert(mesh.crease_pairs.end(), {a, b});
                mesh.crease_weights.push_back(sharpness);
            } else if (tag == "corner" && words >> a >> sharpness) {
                mesh.corners.push_back(a);
                mesh.corner_weights.push_back(sharpness);
            } else ++ignored[tag];
        }
    }
    for (auto const &[tag, count] : ignored) std::printf("note ignored_tag=%s lines=%d\n", tag.c_str(), count);
    return mesh;
}
