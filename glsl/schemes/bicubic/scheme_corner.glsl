// A corner of a regular patch takes nothing from its ring but the frame and the control vertex.
