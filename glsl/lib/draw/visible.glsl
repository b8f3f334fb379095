// The patches of a draw that can be seen, which glsl/compute/cull.comp lists. Rust twin: `ListLayout` in src/renderer/frame/lists.rs.
#ifndef VISIBLE_GLSL
#define VISIBLE_GLSL

#include "constants.glsl"

#ifdef MAKES_LISTS
#define VISIBLE_ACCESS writeonly
#else
#define VISIBLE_ACCESS readonly
#endif

layout(set = 0, binding = 1, std430) VISIBLE_ACCESS buffer Visible {
    // The numbers within the draw of the patches that can be seen, of as many words as there are patches: of each workgroup from
    // where its patches would be on. Then the indirect draws, and what is copied of patches, in the order of the list.
    uint words[];
} visible;

#ifndef MAKES_LISTS
// Whether a draw is of the patches on the list only.
layout(constant_id = ID_LISTED) const bool LISTED = false;

// The number within the draw of the i-th patch that is drawn.
uint patch_drawn(uint i) {
    return LISTED ? visible.words[i] : i;
}
#endif

#endif
