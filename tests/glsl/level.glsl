layout(constant_id = 0) const float LEVEL = 1.0;

void set_levels(float level)
{
    for (int i = 0; i < 4; i++)
        gl_TessLevelOuter[i] = level;
    gl_TessLevelInner[0] = level;
    gl_TessLevelInner[1] = level;
}
