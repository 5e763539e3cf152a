/* How a body that maps describe (parameters.h) meets a point of cloth, in the common subset of C++ and OpenCL
 * C: the test of one point against the tangent planes of its pixel, and the response.
 *
 * The body within a pixel is what lies behind both planes. A plane that is tangent to the front or the back
 * face bounds it far better than the face's depth, which is a flight of stairs: the signed distance from it
 * is continuous within a pixel and nearly so across its edge.
 *
 * Text for many number types like spring_law.h; it stands after node_laws.h (for floor_grip, Coulomb's law).
 */

/* The record of a pixel: of each plane the unit normal, which points out of the body, and n . P (m). */
MSSIM_STRUCT(BodyPlanes) {
  Real front_x, front_y, front_z, front_at;
  Real back_x, back_y, back_z, back_at;
};

/* How a point stands to the body: the signed distance from the nearer plane (m, negative inside, 1e30 where
 * there is no body) and that plane's normal. The body lies behind both planes, so the larger distance is the
 * nearer plane's. */
MSSIM_STRUCT(BodyContact) { Real distance, x, y, z; };

/* A point of cloth before a step: its position (m) and the velocity (m/s) with which it would be moved. */
MSSIM_STRUCT(ClothPoint) { Real x, y, z, u, v, w; };

/* The same after the response. stuck: 1 where friction takes all of the velocity along the body, else 0. */
MSSIM_STRUCT(ClothResponse) { Real x, y, z, u, v, w, stuck; };

/* Column (or row) of a coordinate, not yet truncated to a whole number; last: the number of the last column.
 * Beside the maps, and where the coordinate is not a number, it is a column of the border. */
MSSIM_LAW body_column(Real coordinate, Real first, Real pixels_per_metre, Real last) {
  Real column = (coordinate - first) * pixels_per_metre;
  Real none = last - last;
  /* This order: NaN is not less than `last`. */
  column = where_less(column, last, column, last);
  return where_less(column, none, none, column);
}

MSSIM_GIVES(BodyContact) body_contact(MSSIM_OF(BodyPlanes) planes, Real x, Real y, Real z) {
  Real front =
      mul_add(planes.front_x, x, mul_add(planes.front_y, y, mul_add(planes.front_z, z, -planes.front_at)));
  Real back =
      mul_add(planes.back_x, x, mul_add(planes.back_y, y, mul_add(planes.back_z, z, -planes.back_at)));
  MSSIM_OF(BodyContact) contact;
  contact.distance = where_less(front, back, back, front);
  contact.x = where_less(front, back, planes.back_x, planes.front_x);
  contact.y = where_less(front, back, planes.back_y, planes.front_y);
  contact.z = where_less(front, back, planes.back_z, planes.front_z);
  return contact;
}

/* What the body does to a point. `contact` is that of the position after the step, x + dt v. Where that is
 * inside, the velocity into the body is dropped, and the velocity along it loses at most friction times what
 * was dropped (floor_grip). What of the depth is left then goes out of the position, by at most
 * push_speed * dt: a push by velocity would be motion in the next step, and the point would jitter for ever.
 * A point that leaves the body keeps its velocity. */
MSSIM_GIVES(ClothResponse)
body_response(MSSIM_OF(ClothPoint) point, MSSIM_OF(BodyContact) contact, Real friction, Real push_speed,
              Real dt) {
  Real none = dt - dt;
  Real one = none + 1.0f;
  Real outwards = mul_add(contact.x, point.u, mul_add(contact.y, point.v, contact.z * point.w));
  Real dropped = where_less(outwards, none, -outwards, none);
  dropped = where_less(contact.distance, none, dropped, none);
  Real u = mul_add(dropped, contact.x, point.u);
  Real v = mul_add(dropped, contact.y, point.v);
  Real w = mul_add(dropped, contact.z, point.w);
  Real kept = floor_grip(dropped, mul_add(u, u, mul_add(v, v, w * w)), friction);
  /* Where nothing was dropped the velocity may point out of the body, and is kept whole: floor_grip is 1. */
  Real depth = -mul_add(dropped, dt, contact.distance);
  Real most = push_speed * dt;
  depth = where_less(most, depth, most, depth);
  Real push = where_less(none, depth, depth, none);
  MSSIM_OF(ClothResponse) after;
  after.x = mul_add(push, contact.x, point.x);
  after.y = mul_add(push, contact.y, point.y);
  after.z = mul_add(push, contact.z, point.z);
  after.u = kept * u;
  after.v = kept * v;
  after.w = kept * w;
  after.stuck = where_less(none, kept, none, one);
  return after;
}
