//! Numbers that shaders and the host agree on, with their meanings in `glsl/lib/constants.glsl`.

#![allow(dead_code, reason = "some are of tools, some of shaders alone")]

include!(concat!(env!("OUT_DIR"), "/constants.rs"));
