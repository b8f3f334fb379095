// What the last stage before the fragment shader hands on of instances.
#ifndef INSTANCE_OUT_GLSL
#define INSTANCE_OUT_GLSL

#include "draw/draw.glsl"

layout(location = LOCATION_INSTANCE) flat out uint out_instance;

void hand_on_instance() {
    if (INSTANCES) {
        out_instance = instance_number;
    }
}

#endif
