/* The number type of the OpenCL programs: one Real holds MSSIM_LANES neighbouring nodes (1, 4, 8 or 16). CPU
 * drivers do not map work-items to vector lanes by themselves, so they get wide Reals and few work-items; a
 * GPU does, and gets one node per work-item. The text over Real is the same. Needs MSSIM_LANES; defines the
 * names that the laws need (spring_law.h, node_laws.h, garment_laws.h, body_contact.h).
 */
#define MSSIM_PASTE_(a, b) a##b
#define MSSIM_PASTE(a, b) MSSIM_PASTE_(a, b)

#if MSSIM_LANES == 1
typedef float Real;
typedef int Mask; /* not 0: true */
#define load_lanes(from) (*(from))
#define store_lanes(value, to) (*(to) = (value))
#else
typedef MSSIM_PASTE(float, MSSIM_LANES) Real;
typedef MSSIM_PASTE(int, MSSIM_LANES) Mask; /* sign bit set: true */
#define load_lanes(from) MSSIM_PASTE(vload, MSSIM_LANES)(0, from)
#define store_lanes(value, to) MSSIM_PASTE(vstore, MSSIM_LANES)(value, 0, to)
#endif
/* Access at addresses that are multiples of a Real's size. vload and vstore work there too, but PoCL 3.1
 * splits them into scalar pairs if other writes are near. */
#define load_aligned(from) (*(__global const Real*)(from))
#define load_aligned_mask(from) (*(__global const Mask*)(from))
#define store_aligned(value, to) (*(__global Real*)(to) = (value))

/* any_lane replaces any(), of which PoCL 3.1 makes a branch per lane. lane_number: the number of each lane.
 * from_lane_before, from_lane_after: the value of the neighbouring lane; the first and the last lane keep
 * their own.
 */
#define any_of_four(four) (((four).s0 | (four).s1 | (four).s2 | (four).s3) < 0)
#if MSSIM_LANES == 1
#define any_lane(mask) ((mask) != 0)
#define lane_number ((Mask)(0))
#elif MSSIM_LANES == 4
static inline int any_lane(int4 mask) { return any_of_four(mask); }
#define lane_number ((Mask)(0, 1, 2, 3))
#define from_lane_before(a) (a).s0012
#define from_lane_after(a) (a).s1233
#elif MSSIM_LANES == 8
static inline int any_lane(int8 mask) { return any_of_four(mask.lo | mask.hi); }
#define lane_number ((Mask)(0, 1, 2, 3, 4, 5, 6, 7))
#define from_lane_before(a) (a).s00123456
#define from_lane_after(a) (a).s12345677
#elif MSSIM_LANES == 16
static inline int any_lane(int16 mask) {
  int8 eight = mask.lo | mask.hi;
  return any_of_four(eight.lo | eight.hi);
}
#define lane_number ((Mask)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15))
#define from_lane_before(a) (a).s00123456789abcde
#define from_lane_after(a) (a).s123456789abcdeff
#endif

/* A scalar condition in every lane. */
#define all_lanes(condition) ((Mask)((condition) ? -1 : 0))

#define MSSIM_INLINE static inline __attribute__((always_inline))
#define MSSIM_LAW MSSIM_INLINE Real
#define MSSIM_VECTOR_LAW MSSIM_INLINE Vector
#define MSSIM_STRUCT(Name) struct Name
#define MSSIM_MEMBER(name) Real name;
#define MSSIM_OF(Name) struct Name
#define MSSIM_GIVES(Name) MSSIM_INLINE struct Name
#define mul_add(a, b, c) fma(a, b, c)
#define square_root(a) sqrt(a)
#define inverse_sqrt(a) (1.0f / sqrt(a))
#define where_less(a, b, yes, no) select(no, yes, (a) < (b))

/* Three numbers of every lane's node: a position, a velocity or an acceleration. */
typedef struct {
  Real x, y, z;
} Vector;

/* Every lane's node. */
typedef struct {
  Vector x; /* m */
  Vector v; /* m/s */
} Node;

static inline Vector no_vector(void) {
  Vector nothing = {(Real)(0.0f), (Real)(0.0f), (Real)(0.0f)};
  return nothing;
}
static inline Vector plus(Vector a, Vector b) {
  Vector sum = {a.x + b.x, a.y + b.y, a.z + b.z};
  return sum;
}
static inline Vector minus(Vector a, Vector b) {
  Vector difference = {a.x - b.x, a.y - b.y, a.z - b.z};
  return difference;
}
static inline Vector times(Real s, Vector a) {
  Vector product = {s * a.x, s * a.y, s * a.z};
  return product;
}
static inline Vector times_plus(Real s, Vector a, Vector b) {
  Vector sum = {mul_add(s, a.x, b.x), mul_add(s, a.y, b.y), mul_add(s, a.z, b.z)};
  return sum;
}
static inline Real dot_product(Vector a, Vector b) { return mul_add(a.x, b.x, mul_add(a.y, b.y, a.z * b.z)); }
static inline Vector where(Mask condition, Vector yes, Vector no) {
  Vector chosen = {select(no.x, yes.x, condition), select(no.y, yes.y, condition),
                   select(no.z, yes.z, condition)};
  return chosen;
}

/* Loads components `step` floats apart, the first at an address fit for load_aligned. */
MSSIM_INLINE Vector load_vector(__global const float* from, int step) {
  const Vector value = {load_aligned(from), load_aligned(from + step), load_aligned(from + 2 * step)};
  return value;
}
MSSIM_INLINE void store_vector(Vector value, __global float* to, int step) {
  store_aligned(value.x, to);
  store_aligned(value.y, to + step);
  store_aligned(value.z, to + 2 * step);
}
/* Loads x y z u v w, `step` floats apart. */
MSSIM_INLINE Node load_components(__global const float* from, int step) {
  const Node node = {load_vector(from, step), load_vector(from + 3 * step, step)};
  return node;
}

/* A slice of alike bodies (AlikeSlices in src/backends/layouts): one node of MSSIM_SLICE bodies, its x of all
 * bodies, then y, z, u, v and w. MSSIM_SLICE is a multiple of MSSIM_LANES.
 */
#define slice_floats (6 * MSSIM_SLICE)
