// Gregory patches: the vectors that inner points are made of, transversals among them.
#define INNER 2
#define NEEDS_TRANSVERSALS
