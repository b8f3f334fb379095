// Draws a Catmull-Clark mesh with Pixar OpenSubdiv 3.5 and its own GLSL tessellation shaders
// on Mesa llvmpipe (OpenGL 4.5 core, headless) and prints how long everything took.
//
//   apt-get install -y libosd-dev libegl-dev libgl-dev libepoxy-dev libgl1-mesa-dri libegl1 g++
//   g++ -O2 -std=c++17 -o opensubdiv opensubdiv.cpp -losdGPU -losdCPU -lepoxy -lEGL
//   ./opensubdiv FILE.obj --level 2 --cap gregory --factors 4,8,16,32 --frames 25 --size 1024
//
// libosdGPU brings its own GL loader: it opens libGL.so.1 by dlopen and needs no GLEW, only a
// current context. The GLVND libGL dispatches to whatever context is current, an EGL one too.

#include <epoxy/gl.h>  // before any OpenSubdiv header, which would include <GL/gl.h>
#include <epoxy/egl.h>

#include <opensubdiv/far/patchMap.h>
#include <opensubdiv/far/patchTableFactory.h>
#include <opensubdiv/far/stencilTableFactory.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/osd/cpuEvaluator.h>
#include <opensubdiv/osd/cpuGLVertexBuffer.h>
#include <opensubdiv/osd/glComputeEvaluator.h>
#include <opensubdiv/osd/glPatchTable.h>
#include <opensubdiv/osd/glVertexBuffer.h>
#include <opensubdiv/osd/glslPatchShaderSource.h>
#include <opensubdiv/osd/ompEvaluator.h>

#include "../control_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

using namespace OpenSubdiv;

char const *const kProgram = "opensubdiv";

constexpr int kWarmUpFrames = 6;
constexpr int kSetUpRuns = 9;

// ---------------------------------------------------------------- time and statistics

double median(std::vector<double> v) {
    if (v.empty()) fail("no samples");
    std::sort(v.begin(), v.end());
    size_t n = v.size();
    return n % 2 ? v[n / 2] : 0.5 * (v[n / 2 - 1] + v[n / 2]);
}

// Median absolute deviation.
double spread(std::vector<double> v) {
    double m = median(v);
    for (double &x : v) x = std::fabs(x - m);
    return median(v);
}

// ---------------------------------------------------------------- command line

struct Args {
    std::string file, picture, samples;            // samples: where to write points of the surface
    int grid = 14;                                 // of these, points along each side of a face
    int secondary = -1;                            // isolation level of sharp features; that of all if negative
    bool single_crease = false;
    int level = 2, frames = 25, size = 1024;
    int batch = 4000;                              // evaluated vertices a draw; 1: a draw for every patch
    bool gregory = true;
    std::vector<int> factors = {4, 8, 16, 32};     // segments along the edge of a base quad
    std::array<float, 3> view = {0.5f, 0.4f, 1.0f};  // direction from the model to the eye
};

std::vector<std::string> split(std::string const &text) {
    std::vector<std::string> parts;
    std::stringstream stream(text);
    for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
    return parts;
}

Args parse_args(int argc, char **argv) {
    Args args;
    for (int i = 1; i < argc; ++i) {
        std::string key = argv[i];
        if (key.rfind("--", 0) != 0) { args.file = key; continue; }
        if (++i >= argc) fail(key + " needs a value");
        std::string value = argv[i];
        if (key == "--level") args.level = std::stoi(value);
        else if (key == "--frames") args.frames = std::stoi(value);
        else if (key == "--size") args.size = std::stoi(value);
        else if (key == "--batch") args.batch = std::stoi(value);
        else if (key == "--ppm") args.picture = value;
        else if (key == "--samples") args.samples = value;
        else if (key == "--grid") args.grid = std::stoi(value);
        else if (key == "--secondary") args.secondary = std::stoi(value);
        else if (key == "--single-crease") args.single_crease = value == "1";
        else if (key == "--cap" && (value == "gregory" || value == "bspline")) args.gregory = value == "gregory";
        else if (key == "--factors") {
            args.factors.clear();
            for (auto const &part : split(value)) args.factors.push_back(std::stoi(part));
        } else if (key == "--view" && split(value).size() == 3) {
            for (int k = 0; k < 3; ++k) args.view[k] = std::stof(split(value)[k]);
        } else fail("cannot use " + key + " " + value);
    }
    if (args.file.empty())
        fail("usage: opensubdiv FILE.obj [--level 2] [--cap gregory|bspline] [--factors 4,8,16,32] [--frames 25]"
             " [--size 1024] [--view x,y,z] [--ppm FILE] [--batch 4000] [--single-crease 0|1] [--secondary LEVEL]"
             " [--samples FILE] [--grid 14]");
    return args;
}

// ---------------------------------------------------------------- OpenSubdiv's tables

struct Tables {
    std::unique_ptr<Far::PatchTable const> patches;
    std::unique_ptr<Far::StencilTable const> stencils;  // refined vertices, then end cap points
    double refine_ms = 0, patches_ms = 0, stencils_ms = 0, total_ms = 0;
};

Tables build_tables(Mesh const &mesh, Args const &args) {
    Tables tables;
    double t0 = now_ms();

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

    using RefinerFactory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
    Sdc::Options sdc;
    sdc.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
    std::unique_ptr<Far::TopologyRefiner> refiner(
        RefinerFactory::Create(desc, RefinerFactory::Options(Sdc::SCHEME_CATMARK, sdc)));
    if (!refiner) fail("OpenSubdiv refused the topology");

    Far::PatchTableFactory::Options options(args.level);
    options.SetEndCapType(args.gregory ? Far::PatchTableFactory::Options::ENDCAP_GREGORY_BASIS
                                       : Far::PatchTableFactory::Options::ENDCAP_BSPLINE_BASIS);
    options.useInfSharpPatch = true;
    options.useSingleCreasePatch = args.single_crease;
    options.generateVaryingTables = false;
    options.generateVaryingLocalPoints = false;
    auto refine_options = options.GetRefineAdaptiveOptions();
    if (args.secondary >= 0) refine_options.secondaryLevel = unsigned(args.secondary);
    refiner->RefineAdaptive(refine_options);
    double t1 = now_ms();

    tables.patches.reset(Far::PatchTableFactory::Create(*refiner, options));
    double t2 = now_ms();

    Far::StencilTableFactory::Options stencil_options;
    stencil_options.generateOffsets = true;
    stencil_options.generateIntermediateLevels = true;
    tables.stencils.reset(Far::StencilTableFactory::Create(*refiner, stencil_options));
    if (Far::StencilTable const *local = tables.patches->GetLocalPointStencilTable()) {
        Far::StencilTable const *combined =
            Far::StencilTableFactory::AppendLocalPointStencilTable(*refiner, tables.stencils.get(), local);
        if (combined) tables.stencils.reset(combined);
    }
    double t3 = now_ms();

    tables.refine_ms = t1 - t0;
    tables.patches_ms = t2 - t1;
    tables.stencils_ms = t3 - t2;
    tables.total_ms = t3 - t0;
    return tables;
}

Tables measure_set_up(Mesh const &mesh, Args const &args, std::string const &label) {
    Tables tables;
    std::vector<double> total, refine, patches, stencils;
    for (int run = 0; run < kSetUpRuns + 1; ++run) {
        tables = build_tables(mesh, args);
        if (run == 0) continue;  // the first run pays for page faults
        total.push_back(tables.total_ms);
        refine.push_back(tables.refine_ms);
        patches.push_back(tables.patches_ms);
        stencils.push_back(tables.stencils_ms);
    }
    std::printf("setup %s total_ms=%.2f spread=%.2f refine_ms=%.2f patch_table_ms=%.2f stencils_ms=%.2f\n",
                label.c_str(), median(total), spread(total), median(refine), median(patches), median(stencils));
    return tables;
}

// Writes position and normal at a grid of (u, v) of every face, all of which are quads, as text: v after v, u fastest.
void write_samples(Mesh const &mesh, Tables const &tables, Args const &args) {
    for (int size : mesh.face_sizes)
        if (size != 4) fail("--samples is for meshes of quads");
    std::vector<float> points = mesh.points;
    points.resize(size_t(mesh.vertex_count + tables.stencils->GetNumStencils()) * 3);
    Osd::BufferDescriptor const source(0, 3, 3), target(mesh.vertex_count * 3, 3, 3);
    Osd::CpuEvaluator::EvalStencils(points.data(), source, points.data(), target, tables.stencils->GetSizes().data(),
                                    tables.stencils->GetOffsets().data(), tables.stencils->GetControlIndices().data(),
                                    tables.stencils->GetWeights().data(), 0, tables.stencils->GetNumStencils());
    Far::PatchMap const map(*tables.patches);
    std::ofstream file(args.samples);
    file.precision(9);
    for (int face = 0; face < int(mesh.face_sizes.size()); ++face)
        for (int j = 0; j < args.grid; ++j)
            for (int i = 0; i < args.grid; ++i) {
                double const u = double(i) / (args.grid - 1), v = double(j) / (args.grid - 1);
                auto const *handle = map.FindPatch(face, u, v);
                if (!handle) fail("no patch at a sample");
                float weights[3][20];
                tables.patches->EvaluateBasis(*handle, float(u), float(v), weights[0], weights[1], weights[2]);
                auto const vertices = tables.patches->GetPatchVertices(*handle);
                std::array<double, 3> sums[3] = {};
                for (int k = 0; k < vertices.size(); ++k)
                    for (int of = 0; of < 3; ++of)
                        for (int axis = 0; axis < 3; ++axis)
                            sums[of][axis] += double(weights[of][k]) * points[size_t(vertices[k]) * 3 + axis];
                auto const &du = sums[1], &dv = sums[2];
                for (double x : sums[0]) file << x << ' ';
                file << du[1] * dv[2] - du[2] * dv[1] << ' ' << du[2] * dv[0] - du[0] * dv[2] << ' '
                     << du[0] * dv[1] - du[1] * dv[0] << '\n';
            }
    if (!file) fail("cannot write " + args.samples);
}

// What lies in GL buffers: indices and 12-byte Osd::PatchParam; sizes, offsets, indices, weights of the stencils.
void print_bytes(Tables const &tables, int coarse, std::string const &label) {
    auto const &s = *tables.stencils;
    size_t index = tables.patches->GetPatchControlVerticesTable().size() * sizeof(int);
    size_t param = tables.patches->GetPatchParamTable().size() * sizeof(Osd::PatchParam);
    size_t stencil = s.GetSizes().size() * sizeof(int) + s.GetOffsets().size() * sizeof(int) +
                     s.GetControlIndices().size() * sizeof(int) + s.GetWeights().size() * sizeof(float);
    size_t points = size_t(coarse + s.GetNumStencils()) * 3 * sizeof(float);
    std::printf("bytes %s patch_index=%zu patch_param=%zu stencils=%zu tables_total=%zu tables_mib=%.2f"
                " point_buffer=%zu control_points=%d stencil_weights=%zu\n",
                label.c_str(), index, param, stencil, index + param + stencil,
                double(index + param + stencil) / (1 << 20), points, coarse + s.GetNumStencils(),
                s.GetWeights().size());
}

// ---------------------------------------------------------------- GL context and framebuffer

void create_context() {
    setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
    setenv("GALLIUM_DRIVER", "llvmpipe", 1);
    EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr)) fail("no surfaceless EGL display");
    eglBindAPI(EGL_OPENGL_API);
    EGLint const attributes[] = {EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, 5,
                                 EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
    if (context == EGL_NO_CONTEXT || !eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context))
        fail("no OpenGL 4.5 core context");
    std::string renderer = reinterpret_cast<char const *>(glGetString(GL_RENDERER));
    std::printf("context renderer=\"%s\" version=\"%s\"\n", renderer.c_str(),
                reinterpret_cast<char const *>(glGetString(GL_VERSION)));
    if (renderer.find("llvmpipe") == std::string::npos) fail("the renderer is not llvmpipe");
}

GLuint create_framebuffer(int size) {
    GLuint framebuffer, buffers[2];
    glCreateRenderbuffers(2, buffers);
    glNamedRenderbufferStorage(buffers[0], GL_RGBA8, size, size);
    glNamedRenderbufferStorage(buffers[1], GL_DEPTH_COMPONENT32F, size, size);
    glCreateFramebuffers(1, &framebuffer);
    glNamedFramebufferRenderbuffer(framebuffer, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, buffers[0]);
    glNamedFramebufferRenderbuffer(framebuffer, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, buffers[1]);
    if (glCheckNamedFramebufferStatus(framebuffer, GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) fail("framebuffer");
    return framebuffer;
}

// ---------------------------------------------------------------- control points

using Points = Osd::GLVertexBuffer;
using PointsDesc = Osd::BufferDescriptor;

// One frame: copy the coarse points in, evaluate all stencils on the CPU, upload the whole buffer.
template <class Evaluator>
void measure_cpu_points(char const *name, Mesh const &mesh, Tables const &tables, int frames,
                        Osd::CpuGLVertexBuffer &buffer, std::string const &label) {
    int const coarse = mesh.vertex_count;
    std::vector<double> total, upload;
    for (int frame = -kWarmUpFrames; frame < frames; ++frame) {
        glFinish();
        double t0 = now_ms();
        buffer.UpdateData(mesh.points.data(), 0, coarse);
        Evaluator::EvalStencils(&buffer, PointsDesc(0, 3, 3), &buffer, PointsDesc(coarse * 3, 3, 3),
                                tables.stencils.get());
        double t1 = now_ms();
        buffer.BindVBO();
        glFinish();
        double t2 = now_ms();
        if (frame < 0) continue;
        total.push_back(t2 - t0);
        upload.push_back(t2 - t1);
    }
    std::printf("points %s path=%s total_ms=%.3f spread=%.3f upload_ms=%.3f\n", label.c_str(), name, median(total),
                spread(total), median(upload));
}

// One frame: upload the coarse points, evaluate all stencils in a compute shader.
void measure_glsl_points(Mesh const &mesh, Tables const &tables, int frames, Points &buffer,
                         std::string const &label) {
    int const coarse = mesh.vertex_count;
    PointsDesc const src(0, 3, 3), dst(coarse * 3, 3, 3);
    std::unique_ptr<Osd::GLComputeEvaluator> evaluator(
        Osd::GLComputeEvaluator::Create(src, dst, PointsDesc(), PointsDesc()));
    std::unique_ptr<Osd::GLStencilTableSSBO> stencils(Osd::GLStencilTableSSBO::Create(tables.stencils.get()));
    if (!evaluator || !stencils) fail("GLComputeEvaluator");
    std::vector<double> total;
    for (int frame = -kWarmUpFrames; frame < frames; ++frame) {
        glFinish();
        double t0 = now_ms();
        buffer.UpdateData(mesh.points.data(), 0, coarse);
        Osd::GLComputeEvaluator::EvalStencils(&buffer, src, &buffer, dst, stencils.get(), evaluator.get());
        glMemoryBarrier(GL_ALL_BARRIER_BITS);
        glFinish();
        if (frame >= 0) total.push_back(now_ms() - t0);
    }
    std::printf("points %s path=glsl total_ms=%.3f spread=%.3f\n", label.c_str(), median(total), spread(total));
}

float largest_difference(GLuint a, GLuint b, int floats) {
    std::vector<float> va(floats), vb(floats);
    glGetNamedBufferSubData(a, 0, floats * sizeof(float), va.data());
    glGetNamedBufferSubData(b, 0, floats * sizeof(float), vb.data());
    float largest = 0;
    for (int i = 0; i < floats; ++i) largest = std::max(largest, std::fabs(va[i] - vb[i]));
    return largest;
}

// ---------------------------------------------------------------- shaders

// Everything that OpenSubdiv's shaders leave to the program that uses them.
char const *const kGlue = R"(
layout(std140, binding = 0) uniform Frame {
    mat4 modelView;
    mat4 projection;
    float tessLevel;
};
uniform int primitiveIdBase;
mat4 OsdModelViewMatrix() { return modelView; }
mat4 OsdProjectionMatrix() { return projection; }
mat4 OsdModelViewProjectionMatrix() { return projection * modelView; }  // only for patch culling
float OsdTessLevel() { return tessLevel; }
int OsdGregoryQuadOffsetBase() { return 0; }
int OsdPrimitiveIdBase() { return primitiveIdBase; }
int OsdBaseVertex() { return 0; }
)";

char const *const kFragment = R"(
in block {
    OutputVertex v;
#ifdef OSD_PATCH_ENABLE_SINGLE_CREASE
    vec2 vSegments;
#endif
} inpt;
layout(location = 0) out vec4 color;
void main() {
    vec3 n = normalize(inpt.v.normal);
    float light = max(0.0, dot(n, normalize(vec3(0.3, 0.5, 0.8))));
    color = vec4((0.55 + 0.45 * n) * (0.15 + 0.85 * light), 1.0);
}
)";

bool g_single_crease = false;

GLuint compile(GLenum stage, std::string const &body) {
    std::string const creases = g_single_crease ? "#define OSD_PATCH_ENABLE_SINGLE_CREASE\n" : "";
    std::string source = "#version 450 core\n" + creases + Osd::GLSLPatchShaderSource::GetCommonShaderSource() + kGlue + body;
    char const *text = source.c_str();
    GLuint shader = glCreateShader(stage);
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    GLint ok = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
    if (!ok) {
        char log[4096] = "";
        glGetShaderInfoLog(shader, sizeof log, nullptr, log);
        fail(std::string("shader: ") + log);
    }
    return shader;
}

struct Program {
    GLuint id = 0;
    GLint primitive_id_base = -1;
};

Program build_program(Far::PatchDescriptor::Type type, Args const &args) {
    using Source = Osd::GLSLPatchShaderSource;
    g_single_crease = args.single_crease && type == Far::PatchDescriptor::REGULAR;
    Program program;
    program.id = glCreateProgram();
    for (GLuint shader : {compile(GL_VERTEX_SHADER, Source::GetVertexShaderSource(type)),
                          compile(GL_TESS_CONTROL_SHADER, Source::GetTessControlShaderSource(type)),
                          compile(GL_TESS_EVALUATION_SHADER, Source::GetTessEvalShaderSource(type)),
                          compile(GL_FRAGMENT_SHADER, kFragment)}) {
        glAttachShader(program.id, shader);
        glDeleteShader(shader);
    }
    glLinkProgram(program.id);
    GLint ok = 0;
    glGetProgramiv(program.id, GL_LINK_STATUS, &ok);
    if (!ok) {
        char log[4096] = "";
        glGetProgramInfoLog(program.id, sizeof log, nullptr, log);
        fail(std::string("link: ") + log);
    }
    glProgramUniform1i(program.id, glGetUniformLocation(program.id, "OsdPatchParamBuffer"), 0);
    program.primitive_id_base = glGetUniformLocation(program.id, "primitiveIdBase");
    return program;
}

// ---------------------------------------------------------------- draws

struct Draw {
    Program program;
    int patch_size, patches, first_index, primitive_id_base;
};

// Mesa's draw module cuts an indexed draw every 1024 vertices (gl_PrimitiveID, which OpenSubdiv's control
// shader needs, starts anew there: wrong patch parameters, seen as wrong triangle counts and pictures) and
// holds 16-bit indices of evaluated vertices within such a part. Of the evaluated vertices a draw that are
// right, 4000 was the fastest of 4000 to 65000: no difference up to N=16, 15 % less geometry time at N=32.
constexpr int kMaxPartVertices = 1024, kMaxEvaluated = 65000;

// With OpenSubdiv's uniform tessellation a patch of refinement level l has N / 2^l segments a side.
int evaluated_vertices(Far::PatchParam const &param, int factor) {
    int segments = std::max(1, (factor + (1 << param.GetDepth()) - 1) >> param.GetDepth());
    if (param.GetTransition()) segments = std::max(segments, 2);
    return (segments + 1) * (segments + 1);
}

std::vector<Draw> plan_draws(Far::PatchTable const &far_table, Osd::GLPatchTable const &gl_table,
                             std::map<int, Program> const &programs, int factor, int batch) {
    std::vector<Draw> draws;
    auto const &params = far_table.GetPatchParamTable();
    for (auto const &array : gl_table.GetPatchArrays()) {
        int const patch_size = array.GetDescriptor().GetNumControlVertices();
        int const limit = kMaxPartVertices / patch_size;
        Program const program = programs.at(array.GetDescriptor().GetType());
        int evaluated = 0;
        for (int patch = 0; patch < array.GetNumPatches(); ++patch) {
            int const id = array.GetPrimitiveIdBase() + patch;
            int const cost = evaluated_vertices(params[id], factor);
            if (patch == 0 || draws.back().patches == limit || evaluated + cost > std::min(batch, kMaxEvaluated)) {
                draws.push_back({program, patch_size, 0, array.GetIndexBase() + patch * patch_size, id});
                evaluated = 0;
            }
            ++draws.back().patches;
            evaluated += cost;
        }
    }
    return draws;
}

void submit(std::vector<Draw> const &draws) {
    GLuint bound = 0;
    for (Draw const &draw : draws) {
        if (draw.program.id != bound) {
            bound = draw.program.id;
            glUseProgram(bound);
            glPatchParameteri(GL_PATCH_VERTICES, draw.patch_size);
        }
        glUniform1i(draw.program.primitive_id_base, draw.primitive_id_base);
        glDrawElements(GL_PATCHES, draw.patches * draw.patch_size, GL_UNSIGNED_INT,
                       reinterpret_cast<void *>(size_t(draw.first_index) * sizeof(int)));
    }
}

// The clear is asked for before the clock starts, but llvmpipe does it with the first tiles, within the time.
std::vector<double> measure_frames(std::vector<Draw> const &draws, int frames) {
    std::vector<double> times;
    for (int frame = -kWarmUpFrames; frame < frames; ++frame) {
        glFinish();
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        double t0 = now_ms();
        submit(draws);
        glFinish();
        if (frame >= 0) times.push_back(now_ms() - t0);
    }
    return times;
}

// Triangles made, or vertices evaluated, in one frame.
GLuint64 count(GLenum target, std::vector<Draw> const &draws) {
    GLuint query;
    GLuint64 result = 0;
    glGenQueries(1, &query);
    glBeginQuery(target, query);
    submit(draws);
    glEndQuery(target);
    glGetQueryObjectui64v(query, GL_QUERY_RESULT, &result);
    glDeleteQueries(1, &query);
    return result;
}

// ---------------------------------------------------------------- camera

using Matrix = std::array<float, 16>;  // column major

struct Frame {  // as in kGlue
    Matrix model_view, projection;
    float tess_level, padding[3];
};

std::array<float, 3> normalized(std::array<float, 3> v) {
    float length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    return {v[0] / length, v[1] / length, v[2] / length};
}

std::array<float, 3> cross(std::array<float, 3> a, std::array<float, 3> b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// Looks at the middle of the control points from as far as their bounding sphere needs to be in view whole.
Frame look_at(Mesh const &mesh, std::array<float, 3> view) {
    std::array<float, 3> low = {1e30f, 1e30f, 1e30f}, high = {-1e30f, -1e30f, -1e30f}, middle;
    for (size_t i = 0; i < mesh.points.size(); ++i) {
        low[i % 3] = std::min(low[i % 3], mesh.points[i]);
        high[i % 3] = std::max(high[i % 3], mesh.points[i]);
    }
    for (int k = 0; k < 3; ++k) middle[k] = 0.5f * (low[k] + high[k]);
    float radius = 0;
    for (size_t i = 0; i < mesh.points.size(); i += 3)
        radius = std::max(radius, std::hypot(mesh.points[i] - middle[0], mesh.points[i + 1] - middle[1],
                                             mesh.points[i + 2] - middle[2]));

    float const half_angle = 22.5f * float(M_PI) / 180, distance = 1.02f * radius / std::sin(half_angle);
    auto const z = normalized(view), x = normalized(cross({0, 1, 0}, z)), y = cross(z, x);
    auto shift = [&](std::array<float, 3> const &axis) {
        return -(axis[0] * middle[0] + axis[1] * middle[1] + axis[2] * middle[2]);
    };
    float const near = distance - 1.02f * radius, far = distance + 1.02f * radius, f = 1 / std::tan(half_angle);
    Frame frame{};
    frame.model_view = {x[0], y[0], z[0], 0, x[1], y[1], z[1], 0, x[2], y[2], z[2], 0,
                        shift(x), shift(y), shift(z) - distance, 1};
    frame.projection = {f, 0, 0, 0, 0, f, 0, 0, 0, 0, (far + near) / (near - far), -1,
                        0, 0, 2 * far * near / (near - far), 0};
    return frame;
}

void write_picture(std::string const &path, int size) {
    std::vector<unsigned char> pixels(size_t(size) * size * 3);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, size, size, GL_RGB, GL_UNSIGNED_BYTE, pixels.data());
    std::ofstream file(path, std::ios::binary);
    file << "P6\n" << size << ' ' << size << "\n255\n";
    for (int row = size - 1; row >= 0; --row)
        file.write(reinterpret_cast<char const *>(&pixels[size_t(row) * size * 3]), std::streamsize(size) * 3);
    if (!file) fail("cannot write " + path);
}

// ---------------------------------------------------------------- main

int main(int argc, char **argv) {
    Args const args = parse_args(argc, argv);
    setvbuf(stdout, nullptr, _IOLBF, 0);
    create_context();

    Mesh const mesh = read_obj(args.file);
    std::string name = args.file.substr(args.file.find_last_of('/') + 1);
    name = name.substr(0, name.find('.'));
    std::string label = "mesh=" + name + " level=" + std::to_string(args.level) +
                        " cap=" + (args.gregory ? "gregory" : "bspline");
    Tables const tables = measure_set_up(mesh, args, label);
    label += " patches=" + std::to_string(tables.patches->GetNumPatchesTotal());
    print_bytes(tables, mesh.vertex_count, label);
    if (!args.samples.empty()) {
        write_samples(mesh, tables, args);
        return 0;
    }

    // Control points.
    int const point_count = mesh.vertex_count + tables.stencils->GetNumStencils();
    std::unique_ptr<Osd::CpuGLVertexBuffer> cpu_points(Osd::CpuGLVertexBuffer::Create(3, point_count));
    std::unique_ptr<Points> points(Points::Create(3, point_count));
    measure_cpu_points<Osd::CpuEvaluator>("cpu", mesh, tables, args.frames, *cpu_points, label);
    measure_cpu_points<Osd::OmpEvaluator>("omp", mesh, tables, args.frames, *cpu_points, label);
    measure_glsl_points(mesh, tables, args.frames, *points, label);
    std::printf("check cpu_glsl_largest_difference=%g\n",
                largest_difference(cpu_points->BindVBO(), points->BindVBO(), point_count * 3));

    // Programs and state, bound once.
    std::unique_ptr<Osd::GLPatchTable> gl_patches(Osd::GLPatchTable::Create(tables.patches.get()));
    std::map<int, Program> programs;
    for (auto const &array : gl_patches->GetPatchArrays()) {
        auto const type = array.GetDescriptor().GetType();
        if (!programs.count(type)) programs[type] = build_program(type, args);
        std::printf("patches type=%s count=%d points=%d\n", type == Far::PatchDescriptor::REGULAR ? "regular" : "gregory",
                    array.GetNumPatches(), array.GetDescriptor().GetNumControlVertices());
    }
    GLuint vertex_array, frame_buffer_object;
    glCreateVertexArrays(1, &vertex_array);
    glBindVertexArray(vertex_array);
    glBindBuffer(GL_ARRAY_BUFFER, points->BindVBO());
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 3 * sizeof(float), nullptr);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, gl_patches->GetPatchIndexBuffer());
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_BUFFER, gl_patches->GetPatchParamTextureBuffer());
    glCreateBuffers(1, &frame_buffer_object);
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, frame_buffer_object);
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_CULL_FACE);
    glClearColor(0.08f, 0.08f, 0.1f, 1);

    Frame frame = look_at(mesh, args.view);
    auto prepare = [&](int factor) {
        // OpenSubdiv gives a patch of level l OsdTessLevel / 2^(l-1) segments: half of N is N at level 0.
        frame.tess_level = 0.5f * float(factor);
        glNamedBufferData(frame_buffer_object, sizeof frame, &frame, GL_STATIC_DRAW);
        return plan_draws(*tables.patches, *gl_patches, programs, factor, args.batch);
    };

    if (!args.picture.empty()) {
        int const size = 512;
        glBindFramebuffer(GL_FRAMEBUFFER, create_framebuffer(size));
        glViewport(0, 0, size, size);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        submit(prepare(8));
        write_picture(args.picture, size);
    }

    glBindFramebuffer(GL_FRAMEBUFFER, create_framebuffer(args.size));
    glViewport(0, 0, args.size, args.size);
    for (int factor : args.factors) {
        auto const draws = prepare(factor);
        glEnable(GL_RASTERIZER_DISCARD);
        auto const geometry = measure_frames(draws, args.frames);
        GLuint64 const evaluated = count(GL_TESS_EVALUATION_SHADER_INVOCATIONS, draws);
        GLuint64 const triangles = count(GL_PRIMITIVES_GENERATED, draws);
        glDisable(GL_RASTERIZER_DISCARD);
        auto const pixels = measure_frames(draws, args.frames);
        std::printf("osd %s N=%d size=%d geometry_ms=%.2f spread=%.2f geometry_min=%.2f"
                    " pixels_ms=%.2f pixels_spread=%.2f pixels_min=%.2f triangles=%llu evaluated=%llu draws=%zu\n",
                    label.c_str(), factor, args.size, median(geometry), spread(geometry),
                    *std::min_element(geometry.begin(), geometry.end()), median(pixels), spread(pixels),
                    *std::min_element(pixels.begin(), pixels.end()), (unsigned long long)triangles, (unsigned long long)evaluated, draws.size());
    }
    if (GLenum error = glGetError()) fail("GL error " + std::to_string(error));
    return 0;
}
