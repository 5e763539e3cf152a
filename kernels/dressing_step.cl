/* The kernels that dress a garment by Vassilev's Algorithm 1. A step takes at least four launches:
 *   update_velocities       loops 1, 2 and 4, and the first sweep of loop 5 within the blocks;
 *   correct_between_blocks  sweeps of loop 5 over the springs that join two blocks;
 *   correct_blocks          sweeps within the blocks; after the last of them loop 6;
 *   step_joints             closes what is sewn, and executes loop 3 of the next step (dressing_joints.cl).
 * Needs dressing.cl.
 */

__kernel void update_velocities(GARMENT_GRID, Block blocks, __global const float* pixels, int correct) {
  const GarmentGrid grid = grid_of_arguments;
  Block block = blocks + get_group_id(0);
  const int tiles = block->rows * tiles_of_row(block), draping = state->draping;
  for (int i = item; i < tiles; i += items) update_tile(tile_at(i, block), block, pixels, draping, &grid);
  block_barrier();
  if (correct) correct_block(block, 1, &grid);
}

__kernel void correct_between_blocks(GARMENT_GRID, Block blocks, int forwards_and_back) {
  const GarmentGrid grid = grid_of_arguments;
  Block block = blocks + get_group_id(0);
  if (!block->joins) return;
  correct_seam_of_blocks(block, 1, &grid);
  if (forwards_and_back) correct_seam_of_blocks(block, 0, &grid);
}

/* Nodes at joints and held nodes have their final positions only after step_joints. */
__kernel void correct_blocks(GARMENT_GRID, Block blocks, __global const int* at_joint, int backwards,
                             int forwards, int move) {
  const GarmentGrid grid = grid_of_arguments;
  Block block = blocks + get_group_id(0);
  if (backwards) correct_block(block, 0, &grid);
  if (forwards) correct_block(block, 1, &grid);
  if (!move) return;
  const int tiles = block->rows * tiles_of_row(block);
  for (int i = item; i < tiles; i += items) {
    const int at = tile_at(i, block).at;
    const Mask is_free = (load_aligned(inverse_mass + at) > 0.0f) & (load_aligned_mask(at_joint + at) == 0);
    Vector v = load_vector(velocity + at, rules->plane);
    const Vector x = moved_on(load_vector(moved + at, rules->plane), &v, is_free, rules);
    store_vector(x, position + at, rules->plane);
    store_vector(v, velocity + at, rules->plane);
  }
}
