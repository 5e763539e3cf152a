/* The number type of the OpenCL programs: one Real holds MSSIM_LANES neighbouring nodes (1, 2, 4, 8 or 16).
 * CPU drivers do not turn work-items into vector lanes by themselves, so they get wide Reals and few
 * work-items; a GPU does, and gets one node per work-item. The text over Real is the same.
 * Needs MSSIM_LANES; gives the names that spring_law.h and floor_law.h ask for.
 */
#define MSSIM_PASTE_(a, b) a##b
#define MSSIM_PASTE(a, b) MSSIM_PASTE_(a, b)

#if MSSIM_LANES == 1
typedef float Real;
typedef int Mask; /* not 0: true */
#define load_lanes(from) (*(from))
#define store_lanes(value, to) (*(to) = (value))
#define any_lane(mask) ((mask) != 0)
#else
typedef MSSIM_PASTE(float, MSSIM_LANES) Real;
typedef MSSIM_PASTE(int, MSSIM_LANES) Mask; /* sign bit set: true */
#define load_lanes(from) MSSIM_PASTE(vload, MSSIM_LANES)(0, from)
#define store_lanes(value, to) MSSIM_PASTE(vstore, MSSIM_LANES)(value, 0, to)
#define any_lane(mask) any(mask)
#endif

__constant int lane_numbers[16] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};

/* A scalar condition in every lane. */
#define all_lanes(condition) ((Mask)((condition) ? -1 : 0))

#define MSSIM_LAW static inline Real
#define mul_add(a, b, c) fma(a, b, c)
#define inverse_sqrt(a) (1.0f / sqrt(a))
#define where_less(a, b, yes, no) select(no, yes, (a) < (b))

/* Three numbers of every lane's node: a position, a velocity or an acceleration. */
typedef struct {
  Real x, y, z;
} Vector;

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
