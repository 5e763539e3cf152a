/* Records of eight floats. A record is one load of 32 bytes, so gathering MSSIM_LANES of them takes that many
 * loads and a transposition in registers. A node's record is x y z 0 u v w 0. Needs lanes.h.
 */
#define record_floats 8

/* Every lane's record. */
typedef struct {
  Real a0, a1, a2, a3, a4, a5, a6, a7;
} Records;
static inline Node node_of_records(Records a) {
  Node node = {{a.a0, a.a1, a.a2}, {a.a4, a.a5, a.a6}};
  return node;
}
#define load_records(records, of) node_of_records(load_whole_records(records, of))

#if MSSIM_LANES == 1

/* of(lane): number of the lane's record. */
#define load_whole_records(records, of) load_record(records, of(0))
static inline Records load_record(__global const float* records, size_t number) {
  float4 a = *(__global const float4*)(records + record_floats * number);
  float4 b = *(__global const float4*)(records + record_floats * number + 4);
  Records all = {a.x, a.y, a.z, a.w, b.x, b.y, b.z, b.w};
  return all;
}

/* Stores the lane's vector as x y z 0. */
static inline void store_quads(Vector value, __global float* to, size_t distance) {
  *(__global float4*)to = (float4)(value.x, value.y, value.z, 0.0f);
}

#else

/* Shuffles within each four elements of a and b: a0 b0 a1 b1, a2 b2 a3 b3, a0 a1 b0 b1, a2 a3 b2 b3. Each
 * selects between two constant permutations, which compilers turn into one instruction. */
#define odd_4 ((int4)(0, -1, 0, -1))
#define odd_8 ((int8)(odd_4, odd_4))
#define odd_16 ((int16)(odd_8, odd_8))
#define late_4 ((int4)(0, 0, -1, -1))
#define late_8 ((int8)(late_4, late_4))
#define late_16 ((int16)(late_8, late_8))
#define low_pairs_4(a, b) (odd_4 ? (b).s0011 : (a).s0011)
#define high_pairs_4(a, b) (odd_4 ? (b).s2233 : (a).s2233)
#define low_halves_4(a, b) (late_4 ? (b).s0101 : (a).s0101)
#define high_halves_4(a, b) (late_4 ? (b).s2323 : (a).s2323)
#define low_pairs_8(a, b) (odd_8 ? (b).s00114455 : (a).s00114455)
#define high_pairs_8(a, b) (odd_8 ? (b).s22336677 : (a).s22336677)
#define low_halves_8(a, b) (late_8 ? (b).s01014545 : (a).s01014545)
#define high_halves_8(a, b) (late_8 ? (b).s23236767 : (a).s23236767)
#define low_pairs_16(a, b) (odd_16 ? (b).s001144558899ccdd : (a).s001144558899ccdd)
#define high_pairs_16(a, b) (odd_16 ? (b).s22336677aabbeeff : (a).s22336677aabbeeff)
#define low_halves_16(a, b) (late_16 ? (b).s010145458989cdcd : (a).s010145458989cdcd)
#define high_halves_16(a, b) (late_16 ? (b).s23236767ababefef : (a).s23236767ababefef)

/* Loads the records of(0) to of(MSSIM_LANES - 1). */
#define record_at(records, number) (*(__global const float8*)((records) + record_floats * (size_t)(number)))

#if MSSIM_LANES == 4
#define load_whole_records(records, of)                                                         \
  transposed_4(record_at(records, of(0)), record_at(records, of(1)), record_at(records, of(2)), \
               record_at(records, of(3)))
static inline Records transposed_4(float8 a, float8 b, float8 c, float8 d) {
  float8 ab_low = low_pairs_8(a, b), ab_high = high_pairs_8(a, b);
  float8 cd_low = low_pairs_8(c, d), cd_high = high_pairs_8(c, d);
  float8 xu = low_halves_8(ab_low, cd_low), yv = high_halves_8(ab_low, cd_low),
         zw = low_halves_8(ab_high, cd_high), last = high_halves_8(ab_high, cd_high);
  Records all = {xu.lo, yv.lo, zw.lo, last.lo, xu.hi, yv.hi, zw.hi, last.hi};
  return all;
}
#else
/* Eight records, two per register; first halves in the even, second in the odd quarters. */
typedef struct {
  float16 xu, yv, zw, last;
} EightRecords;
/* Joins wider integers, because PoCL 3.1 would move the following shuffles to the halves, which doubles their
 * number.
 */
#define beside(a, b) as_float16((ulong8)(as_ulong4(a), as_ulong4(b)))
static inline EightRecords transposed_8(float8 a, float8 b, float8 c, float8 d, float8 e, float8 f, float8 g,
                                        float8 h) {
  float16 ae = beside(a, e), bf = beside(b, f), cg = beside(c, g), dh = beside(d, h);
  float16 ab_low = low_pairs_16(ae, bf), ab_high = high_pairs_16(ae, bf);
  float16 cd_low = low_pairs_16(cg, dh), cd_high = high_pairs_16(cg, dh);
  EightRecords all = {low_halves_16(ab_low, cd_low), high_halves_16(ab_low, cd_low),
                      low_halves_16(ab_high, cd_high), high_halves_16(ab_high, cd_high)};
  return all;
}
#define load_eight(records, of, from)                                              \
  transposed_8(record_at(records, of(from)), record_at(records, of(from + 1)),     \
               record_at(records, of(from + 2)), record_at(records, of(from + 3)), \
               record_at(records, of(from + 4)), record_at(records, of(from + 5)), \
               record_at(records, of(from + 6)), record_at(records, of(from + 7)))
#define first_halves(pair) (pair).s012389ab
#define second_halves(pair) (pair).s4567cdef
#if MSSIM_LANES == 8
#define load_whole_records(records, of) records_of_eight(load_eight(records, of, 0))
static inline Records records_of_eight(EightRecords all) {
  Records these = {first_halves(all.xu),   first_halves(all.yv),   first_halves(all.zw),
                   first_halves(all.last), second_halves(all.xu),  second_halves(all.yv),
                   second_halves(all.zw),  second_halves(all.last)};
  return these;
}
#else
#define load_whole_records(records, of) \
  records_of_sixteen(load_eight(records, of, 0), load_eight(records, of, 8))
#define of_both(halves, field) (float16)(halves(low.field), halves(high.field))
static inline Records records_of_sixteen(EightRecords low, EightRecords high) {
  Records these = {of_both(first_halves, xu),   of_both(first_halves, yv),   of_both(first_halves, zw),
                   of_both(first_halves, last), of_both(second_halves, xu),  of_both(second_halves, yv),
                   of_both(second_halves, zw),  of_both(second_halves, last)};
  return these;
}
#endif
#endif

/* The vectors of every fourth lane, as x y z 0 each: lanes 0, 4, 8 .., lanes 1, 5, 9 .. and so on. */
typedef struct {
  Real from_0, from_1, from_2, from_3;
} Quads;
static inline Quads quads_of(Vector value) {
  const Real zero = (Real)(0.0f);
  const Real xy_low = MSSIM_PASTE(low_pairs_, MSSIM_LANES)(value.x, value.y);
  const Real xy_high = MSSIM_PASTE(high_pairs_, MSSIM_LANES)(value.x, value.y);
  const Real z_low = MSSIM_PASTE(low_pairs_, MSSIM_LANES)(value.z, zero);
  const Real z_high = MSSIM_PASTE(high_pairs_, MSSIM_LANES)(value.z, zero);
  Quads quads = {MSSIM_PASTE(low_halves_, MSSIM_LANES)(xy_low, z_low),
                 MSSIM_PASTE(high_halves_, MSSIM_LANES)(xy_low, z_low),
                 MSSIM_PASTE(low_halves_, MSSIM_LANES)(xy_high, z_high),
                 MSSIM_PASTE(high_halves_, MSSIM_LANES)(xy_high, z_high)};
  return quads;
}

/* Stores the quads of every fourth lane, `distance` floats apart from lane to lane. */
static inline void store_every_fourth(Real quads, __global float* to, size_t distance) {
#if MSSIM_LANES == 4
  *(__global float4*)to = quads;
#else
  *(__global float4*)to = quads.s0123;
  *(__global float4*)(to + 4 * distance) = quads.s4567;
#endif
#if MSSIM_LANES == 16
  *(__global float4*)(to + 8 * distance) = quads.s89ab;
  *(__global float4*)(to + 12 * distance) = quads.scdef;
#endif
}

/* Stores every lane's vector as x y z 0, `distance` floats apart from lane to lane. */
static inline void store_quads(Vector value, __global float* to, size_t distance) {
  const Quads quads = quads_of(value);
  store_every_fourth(quads.from_0, to, distance);
  store_every_fourth(quads.from_1, to + distance, distance);
  store_every_fourth(quads.from_2, to + 2 * distance, distance);
  store_every_fourth(quads.from_3, to + 3 * distance, distance);
}

#endif
