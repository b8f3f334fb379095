// The displacement: the crate's or the caller's own.
#ifndef DISPLACED_GLSL
#define DISPLACED_GLSL

#ifdef OWN_DISPLACE
#include "own_displace.glsl"
#else
#include "displace/displace.glsl"
#endif

#endif
