/* Where the pixels of a body's maps lie and what one holds, in the common subset of C++ and OpenCL C: the
 * host fills this struct and the device reads it (src/garment/contact/body_maps.h).
 *
 * Pixel (column, row) covers x from left + column / pixels_per_metre on and y from bottom + row /
 * pixels_per_metre on; row 0 is the lowest. Its record of BODY_FLOATS floats begins at
 * BODY_FLOATS * (row * columns + column): unit normal x y z and n . P of the front plane, then the same of
 * the back plane. Where there is no body both are 0 0 0 and -1e30, which no point is behind. The pixels along
 * the border hold none, so that points beside the maps read there what is right for them.
 */
struct BodyFrame {
  float left;   /* m, x of the left edge of column 0 */
  float bottom; /* m, y of the lower edge of row 0 */
  float pixels_per_metre;
  int columns;
  int rows;
};
#define BODY_FLOATS 8
