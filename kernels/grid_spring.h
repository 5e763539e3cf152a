/* A spring of a cloth, used by the kernels of both shapes. Needs lanes.h, spring_law.h and parameters.h.
 */
#if MSSIM_LANES == 1
typedef __constant struct GridParameters* Shape;
#else
typedef const struct GridParameters* Shape; /* a copy: stores to the cloth cannot change it */
#endif

/* Adds the force of one spring in every lane to the forces on its ends, m/s^2. If there is no spring, because
 * the cloth ends, the result computed from the padding is masked out. */
MSSIM_INLINE void add_spring(Vector* on_first, Vector* on_second, Node first, Node second, Mask there,
                             int kind, Shape grid) {
  Vector d = minus(second.x, first.x);
  Real pull = spring_pull(dot_product(d, d), dot_product(minus(second.v, first.v), d),
                          spring_in_every_lane(grid->constants[kind], (Real)(grid->stiffness_rest[kind])));
  pull = select((Real)(0.0f), pull, there);
  *on_first = times_plus(pull, d, *on_first);
  *on_second = times_plus(-pull, d, *on_second);
}
