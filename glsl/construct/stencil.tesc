// The stencil construction: every control point is a weighted sum of the vertices around the patch, with the weights of
// its type of connectivity (Loop et al. 2009, section 4). Compiled for patches whose corners own 4, 5 .. control points.
// variants: OWNED=4, OWNED=4+CAPTURE, OWNED=4+CAPTURE_POINTS, OWNED=4+TEXCOORD
// variants: OWNED=4+SHARED, OWNED=4+SHARED+CAPTURE, OWNED=4+SHARED+TEXCOORD, OWNED=4+DISPLACED, OWNED=4+DISPLACED+CAPTURE
// variants: OWNED=5, OWNED=5+CAPTURE, OWNED=5+CAPTURE_POINTS, OWNED=5+TEXCOORD
// variants: OWNED=5+SHARED, OWNED=5+SHARED+CAPTURE, OWNED=5+SHARED+TEXCOORD, OWNED=5+DISPLACED, OWNED=5+DISPLACED+CAPTURE
// variants: OWNED=6, OWNED=6+CAPTURE, OWNED=6+CAPTURE_POINTS, OWNED=6+TEXCOORD
// variants: OWNED=6+TRIANGLE, OWNED=6+TRIANGLE+CAPTURE, OWNED=6+TRIANGLE+CAPTURE_POINTS, OWNED=6+TRIANGLE+TEXCOORD
// variants: OWNED=6+PENTAGON, OWNED=6+PENTAGON+CAPTURE, OWNED=6+PENTAGON+CAPTURE_POINTS, OWNED=6+PENTAGON+TEXCOORD
// variants: OWNED=8, OWNED=8+CAPTURE, OWNED=8+CAPTURE_POINTS, OWNED=8+TEXCOORD
// variants: OWNED=5+TRIANGLE, OWNED=5+TRIANGLE+CAPTURE, OWNED=5+TRIANGLE+CAPTURE_POINTS, OWNED=5+TRIANGLE+TEXCOORD
// variants: OWNED=5+TRIANGLE+SHARED, OWNED=5+TRIANGLE+SHARED+CAPTURE, OWNED=5+TRIANGLE+SHARED+TEXCOORD, OWNED=5+TRIANGLE+DISPLACED, OWNED=5+TRIANGLE+DISPLACED+CAPTURE
#version 460
#extension GL_GOOGLE_include_directive : require
#ifndef OWNED
#define OWNED 4
#endif
#include "construct/control.glsl"
#include "construct/stencils.glsl"
#ifdef SHARED
#include "edges/shared.glsl"
#include "edges/write_shared.glsl"
#endif
#ifdef DISPLACED
#include "displace/corner_lod.glsl"
#endif

layout(location = 0) in uint in_patch_number[];

void main() {
    stencil_points(draw.first_patch + in_patch_number[0], uint(gl_InvocationID), CORNERS, own);
#ifdef SHARED
    uint corner = draw.first_corner + in_patch_number[0] * CORNERS + uint(gl_InvocationID);
    uvec2 place = patch_corner(corner);
    FramedRing own = framed_ring(place.x), speaker = own;
    float lod = 0.0;
#ifdef DISPLACED
    speaker = corner_speaker(corner, own);
    lod = corner_lod(corner, speaker);
#endif
    SharedEdge plus = shared_edge(own, place.y), minus = shared_edge(own, edge_after(own.ring, place.y));
    write_shared(corner, share_corner(corner, own, speaker, plus, minus), corner_sharp(corner), lod);
#endif
    finish_corner(in_patch_number[0]);
    barrier();
    finish_patch(in_patch_number[0]);
}
