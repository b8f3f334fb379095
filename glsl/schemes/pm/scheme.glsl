// Pm-patches: the vectors that inner points are made of. The invocations of a patch make their control points out of those of each
// other.
#define INNER 3
#define OWNED_IS_SHARED
