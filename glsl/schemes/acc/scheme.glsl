// ACC patches: the vectors that inner points are made of.
#define INNER 5
