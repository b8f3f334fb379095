//! Tessellations have no holes, whatever the depths.
