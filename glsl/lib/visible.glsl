// The patches of a draw that can be seen: what glsl/compute/cull.comp finds and glsl/compute/compact.comp lists. Rust twin:
// src/renderer/lists.rs.
#ifndef VISIBLE_GLSL
#define VISIBLE_GLSL

#ifdef MAKES_LISTS
#define VISIBLE_ACCESS
#else
#define VISIBLE_ACCESS readonly
#endif

layout(set = 0, binding = 1, std430) VISIBLE_ACCESS buffer Visible {
    // Of the indirect draws.
    uint commands[8];
    // The numbers within the draw of the patches that can be seen, one after the other, in as many words as there are patches;
    // then for each patch whether it can be seen.
    uint patches[];
} visible;

#ifndef MAKES_LISTS
// Whether a draw is of the patches on the list only.
layout(constant_id = 10) const bool LISTED = false;

// The number within the draw of the i-th patch that is drawn.
uint patch_drawn(uint i) {
    return LISTED ? visible.patches[i] : i;
}
#endif

#endif
