/* Code shared by the kernels that dress a garment (dressing_step.cl, dressing_joints.cl). The garment's nodes
 * lie in rows (GarmentGrid in src/garment/stepping/garment_grid.h). An array of vectors is three planes, x, y
 * and z.
 *
 * A work-group takes a block of rows. On a GPU its work-items share the nodes, one per Real, and synchronise
 * at barriers; on a CPU it is one work-item, which takes MSSIM_LANES neighbours of a row at a time. Every sum
 * and every correction has the same order either way. The springs of a row are those that its nodes own:
 * stencil_rows and stencil_columns are panel_stencil, generated from it.
 */
typedef __constant struct DressingParameters* Rules;
typedef __global const struct DressingBlock* Block;

typedef struct {
  __global float* position;           /* m, at the start of a step */
  __global float* moved;              /* m, after contact within the step */
  __global float* velocity;           /* m/s */
  __global float* pull;               /* m/s^2, from joints */
  __global const float* inverse_mass; /* 1/kg, 0 for pins and padding */
  __global float* free;               /* inverse_mass, but 0 also for nodes that friction holds */
  __global const float* rest;         /* [direction] m, 0: no spring */
  __global const float* stiffness;    /* [direction][row] N/m */
  Rules rules;
  int plane; /* floats from one component, or direction, to the next */
} GarmentGrid;

#if MSSIM_LANES == 1
/* Makes everything that the items of the group have written so far visible to all of them. */
#define block_barrier() barrier(CLK_GLOBAL_MEM_FENCE)
#define first_lane(a) (a)
#define to_index(a) convert_int(a)
#else
#define block_barrier()
#define first_lane(a) (a).s0
#define to_index(a) MSSIM_PASTE(convert_int, MSSIM_LANES)(a)
#endif
#define item ((int)get_local_id(0))
#define items ((int)get_local_size(0))

MSSIM_INLINE Vector load_vector_anywhere(__global const float* from, int plane) {
  Vector value = {load_lanes(from), load_lanes(from + plane), load_lanes(from + 2 * plane)};
  return value;
}
MSSIM_INLINE void store_vector_anywhere(Vector value, __global float* to, int plane) {
  store_lanes(value.x, to);
  store_lanes(value.y, to + plane);
  store_lanes(value.z, to + 2 * plane);
}
/* One node's vector, the same in every lane. */
MSSIM_INLINE Vector load_one(__global const float* from, int plane) {
  Vector value = {(Real)(from[0]), (Real)(from[plane]), (Real)(from[2 * plane])};
  return value;
}
MSSIM_INLINE void store_one(Vector value, __global float* to, int plane) {
  to[0] = first_lane(value.x);
  to[plane] = first_lane(value.y);
  to[2 * plane] = first_lane(value.z);
}

/* MSSIM_LANES neighbours of a row of a block. */
typedef struct {
  int row; /* within the block */
  int at;  /* offset of the first, in floats */
} Tile;
MSSIM_INLINE int tiles_of_row(Block block) { return (block->columns + MSSIM_LANES - 1) / MSSIM_LANES; }
MSSIM_INLINE Tile tile_at(int number, Block block) {
  Tile tile;
  tile.row = number / tiles_of_row(block);
  tile.at = block->first + tile.row * block->stride + number % tiles_of_row(block) * MSSIM_LANES;
  return tile;
}

/* Force of springs to nodes at `away`, N. */
MSSIM_INLINE Vector spring_force(Vector away, Real rest, float stiffness) {
  const struct SpringConstants undamped = {(Real)(stiffness)}; /* the others are zero */
  Real pull = spring_pull(dot_product(away, away), (Real)(0.0f), linear_spring(undamped, rest));
  return times(select(pull, (Real)(0.0f), rest <= 0.0f), away);
}

/* Loop 1: for each direction, the spring that a node owns and the one that ends at it. */
MSSIM_INLINE Vector spring_forces(Tile tile, Block block, const GarmentGrid* grid) {
  const Vector own = load_vector(grid->position + tile.at, grid->plane);
  Vector sum = no_vector();
  for (int d = 0; d < stencil_directions; ++d) {
    const int offset = stencil_rows[d] * block->stride + stencil_columns[d];
    __global const float* rest = grid->rest + d * grid->plane + tile.at;
    __global const float* stiffness = grid->stiffness + d * grid->rules->spring_rows + block->row + tile.row;
    const Vector next = load_vector_anywhere(grid->position + tile.at + offset, grid->plane);
    const Vector last = load_vector_anywhere(grid->position + tile.at - offset, grid->plane);
    sum = plus(sum, spring_force(minus(next, own), load_aligned(rest), *stiffness));
    sum = plus(sum, spring_force(minus(last, own), load_lanes(rest - offset), stiffness[-stencil_rows[d]]));
  }
  return sum;
}

/* Loop 4, second half: contact of nodes with the body. Returns the mask of nodes that friction holds. */
#define pixel_record(lane) pixel_numbers[lane]
MSSIM_INLINE Mask touch_body(Block block, __global const float* pixels, float friction, Mask real, Vector* x,
                             Vector* v, Rules rules) {
  __global const struct BodyFrame* body = &block->body;
  const Real dt = (Real)(rules->dt), scale = (Real)(body->pixels_per_metre);
  const Vector next = times_plus(dt, *v, *x);
  const Mask column = to_index(body_column(next.x, (Real)(body->left), scale, (Real)(body->columns - 1)));
  const Mask row = to_index(body_column(next.y, (Real)(body->bottom), scale, (Real)(body->rows - 1)));
  int pixel_numbers[MSSIM_LANES];
  store_lanes(block->first_pixel + row * body->columns + column, pixel_numbers);
  const Records a = load_whole_records(pixels, pixel_record);
  const struct BodyPlanes planes = {a.a0, a.a1, a.a2, a.a3, a.a4, a.a5, a.a6, a.a7};
  const struct BodyContact contact = body_contact(planes, next.x, next.y, next.z);
  const Mask inside = real & (contact.distance < 0.0f);
  if (!any_lane(inside)) return inside;
  const struct ClothPoint point = {x->x, x->y, x->z, v->x, v->y, v->z};
  const struct ClothResponse after =
      body_response(point, contact, (Real)(friction), (Real)(rules->push_speed), dt);
  const Vector x_after = {after.x, after.y, after.z}, v_after = {after.u, after.v, after.w};
  *x = where(inside, x_after, *x);
  *v = where(inside, v_after, *v);
  return inside & (after.stuck > 0.0f);
}

/* Loops 1, 2 and 4 for a tile. */
MSSIM_INLINE void update_tile(Tile tile, Block block, __global const float* pixels, int draping,
                              const GarmentGrid* grid) {
  Rules rules = grid->rules;
  const int plane = grid->plane;
  __constant struct DressingPhase* phase = draping ? &rules->draping : &rules->seaming;
  const Real inverse_mass = load_aligned(grid->inverse_mass + tile.at);
  const Mask real = inverse_mass > 0.0f;
  Vector x = load_vector(grid->position + tile.at, plane);
  Vector v = load_vector(grid->velocity + tile.at, plane);
  Vector a = node_acceleration_unfused(times(inverse_mass, spring_forces(tile, block, grid)), v,
                                       (Real)(phase->damping), (Real)(phase->gravity));
  if (!draping) a = plus(a, load_vector(grid->pull + tile.at, plane));
  v = times_plus((Real)(rules->dt), where(real, a, no_vector()), v);
  Real free = inverse_mass;
  if (block->body.columns > 0)
    free = select(free, (Real)(0.0f), touch_body(block, pixels, phase->friction, real, &x, &v, rules));
  store_aligned(free, grid->free + tile.at);
  store_vector(v, grid->velocity + tile.at, plane);
  store_vector(x, grid->moved + tile.at, plane);
}

/* Loop 5, as in C++ in src/garment/stepping/step_panels.cpp, which also names the test that compares the two.
 *
 * Corrects springs of a direction, from a tile to rows below, which have no node in common. */
MSSIM_INLINE void correct_springs(int at, int direction, Block block, const GarmentGrid* grid) {
  const int plane = grid->plane, far_at = at + block->stride + stencil_columns[direction];
  const Vector d =
      minus(load_vector_anywhere(grid->moved + far_at, plane), load_vector(grid->moved + at, plane));
  const Real squared = dot_product(d, d);
  const Real limit = load_aligned(grid->rest + direction * plane + at) * grid->rules->correction_limit;
  const Mask acts = elongation_excess(squared, limit) > 0.0f;
  if (!any_lane(acts)) return;
  const Vector own = load_vector(grid->velocity + at, plane);
  const Vector far = load_vector_anywhere(grid->velocity + far_at, plane);
  const Real own_free = load_aligned(grid->free + at), far_free = load_lanes(grid->free + far_at);
  const Real impulse = elongation_impulse(squared, dot_product(minus(far, own), d), limit,
                                          (Real)(grid->rules->correction_rate), own_free + far_free);
  /* Inactive springs change nothing, not even by adding 0: that would turn -0 into 0 for some tile shapes and
   * not for others. */
  const Vector own_after = times_plus(own_free * impulse, d, own);
  const Vector far_after = times_plus(-(far_free * impulse), d, far);
  store_vector(where(acts, own_after, own), grid->velocity + at, plane);
  store_vector_anywhere(where(acts, far_after, far), grid->velocity + far_at, plane);
}

/* Corrects one spring along a row if it is longer than its limit. */
MSSIM_INLINE void correct_along_row(int at, const GarmentGrid* grid) {
  const int plane = grid->plane;
  const Vector d = minus(load_one(grid->moved + at + 1, plane), load_one(grid->moved + at, plane));
  const Vector own = load_one(grid->velocity + at, plane), far = load_one(grid->velocity + at + 1, plane);
  const Real own_free = (Real)(grid->free[at]), far_free = (Real)(grid->free[at + 1]);
  const Real impulse = elongation_impulse(dot_product(d, d), dot_product(minus(far, own), d),
                                          (Real)(grid->rest[at] * grid->rules->correction_limit),
                                          (Real)(grid->rules->correction_rate), own_free + far_free);
  store_one(times_plus(own_free * impulse, d, own), grid->velocity + at, plane);
  store_one(times_plus(-(far_free * impulse), d, far), grid->velocity + at + 1, plane);
}

/* Corrects the springs along rows, one after the other within a row: MSSIM_LANES of them are tested together,
 * and those that are too long, usually few, are corrected in order. */
MSSIM_INLINE void correct_rows(Block block, int forwards, const GarmentGrid* grid) {
  const int plane = grid->plane, tiles = tiles_of_row(block);
  for (int row = item; row < block->rows; row += items)
    for (int i = 0; i < tiles; ++i) {
      const int tile = forwards ? i : tiles - 1 - i;
      const int at = block->first + row * block->stride + tile * MSSIM_LANES;
      const Vector d =
          minus(load_vector_anywhere(grid->moved + at + 1, plane), load_vector(grid->moved + at, plane));
      const Real limit = load_aligned(grid->rest + at) * grid->rules->correction_limit;
      const Real excess = elongation_excess(dot_product(d, d), limit);
      if (!any_lane(excess > 0.0f)) continue;
      float excesses[MSSIM_LANES];
      store_lanes(excess, excesses);
      for (int k = 0; k < MSSIM_LANES; ++k) {
        const int lane = forwards ? k : MSSIM_LANES - 1 - k;
        if (excesses[lane] > 0.0f) correct_along_row(at + lane, grid);
      }
    }
}

/* Corrects the springs of a direction between two rows. The upper one is row `row` of a block, or the row
 * before the block (-1). */
MSSIM_INLINE void correct_between_rows(Block block, int row, int direction, const GarmentGrid* grid) {
  const int start = block->first + row * block->stride;
  for (int column = item * MSSIM_LANES; column < block->columns; column += items * MSSIM_LANES)
    correct_springs(start + column, direction, block, grid);
}

/* Corrects the springs of a direction between all rows of a block. On a GPU an item takes a line of them,
 * from the first row to the last; different lines have no node in common. */
MSSIM_INLINE void correct_diagonals(Block block, int direction, int forwards, const GarmentGrid* grid) {
  const int rows = block->rows - 1;
#if MSSIM_LANES == 1
  for (int line = item; line < block->columns + rows; line += items)
    for (int k = 0; k < rows; ++k) {
      const int row = forwards ? k : rows - 1 - k, right = stencil_columns[direction];
      const int column = line + right * row - (right > 0 ? rows : 0);
      if (column >= 0 && column < block->columns)
        correct_springs(block->first + row * block->stride + column, direction, block, grid);
    }
#else
  for (int k = 0; k < rows; ++k) correct_between_rows(block, forwards ? k : rows - 1 - k, direction, grid);
#endif
}

/* A sweep of loop 5 over the springs within a block, in the order of garment_grid.h. */
MSSIM_INLINE void correct_block(Block block, int forwards, const GarmentGrid* grid) {
  for (int i = 0; i < limited_directions; ++i) {
    const int direction = forwards ? i : limited_directions - 1 - i;
    if (direction == 0)
      correct_rows(block, forwards, grid);
    else
      correct_diagonals(block, direction, forwards, grid);
    block_barrier();
  }
}

/* A sweep of loop 5 over the springs between a block and the one before it. */
MSSIM_INLINE void correct_seam_of_blocks(Block block, int forwards, const GarmentGrid* grid) {
  for (int i = 1; i < limited_directions; ++i) {
    correct_between_rows(block, -1, forwards ? i : limited_directions - i, grid);
    block_barrier();
  }
}

/* Loop 6: the positions of nodes at x after the step. The floor changes v. */
MSSIM_INLINE Vector moved_on(Vector x, Vector* v, Mask is_free, Rules rules) {
  x = times_plus((Real)(rules->dt), *v, x);
  touch_floor(&x, v, is_free, &rules->surroundings);
  return x;
}

/* The first parameters of every kernel. */
#define GARMENT_GRID                                                                            \
  __constant struct DressingParameters *rules, __global float *position, __global float *moved, \
      __global float *velocity, __global float *pull, __global const float *inverse_mass,       \
      __global float *free, __global const float *rest, __global const float *stiffness,        \
      __global struct DressingState *state
#define grid_of_arguments \
  { position, moved, velocity, pull, inverse_mass, free, rest, stiffness, rules, rules->plane }
