"""Drawing of a run in three dimensions, by PyVista. Lengths are in m, values in the unit of their label."""

from __future__ import annotations

import contextlib
import math
from pathlib import Path

import numpy as np

from ._frames import BAR, DISK, EDGE, QUANTITIES, Source, outside, tractions
from ._optional import optional
from ._views import APART, ARROW, Bounds, Pane, Seen, behind, rounded, scale, thinned

INK, LINES = "#202020", "#606060"
# colour map, and where it begins: bodies are not as white as the paper
COLOURS = {"fields": ("Blues", 0.12), "contact": ("YlOrRd", 0.0)}
# rows of a picture over its width: heading, titles, views, colour bars
HEADING, TITLES, KEYS = 0.035, 0.04, 0.07
# width of each view, and height of the views, over the width of the picture
LAYOUTS = {"both": ((0.3, 0.7), 0.44), "one": ((1.0,), 0.6), "surfaces": ((0.5, 0.5), 0.4)}


class Scene:
    """The picture of a run, its views side by side.

    Args:
        source: the records of the bodies or of the contact surfaces.
        contact: the records of the contact surfaces, or None.
        options: as of ``Run.render``: field, view, magnify, span, width.
        title: stands in the heading.
    """

    def __init__(self, source: Source, contact: Source | None, options: dict, title: str):
        self.source, self.contact, self.title = source, contact, title
        self.quantity, self.width = options["field"], options["width"]
        bodies, view = source.what == "fields", options["view"] or "both"
        self.of_arrows = "slip_velocity" if self.quantity == "slip_velocity" else "shear"
        if bodies:
            panes = {"whole": self.of_whole, "contact": self.of_contact}
            self.panes = [make() for name, make in panes.items() if view in ("both", name)]
        else:
            self.panes = self.of_surfaces()
        for pane in self.panes:
            pane.magnify = math.nan if options["magnify"] is None else options["magnify"]
            if options["span"] is not None and not pane.whole:
                pane.span = options["span"]
        self.shares, height = LAYOUTS["one" if len(self.panes) == 1 else "both" if bodies else "surfaces"]
        self.rows = (HEADING, TITLES, height, KEYS)
        self.size = self.width, 2 * round(0.5 * self.width * sum(self.rows))
        self.plotter = None

    def of_whole(self):
        """Both bodies."""
        return Pane("whole", outside(self.source.cells), *Seen.WHOLE, self.source.half, whole=True)

    def of_contact(self):
        """The contact from near, cut along the middle, the disk lifted where the tractions on the bar are known."""
        kept = behind(self.source)
        title = "contact, cut at y = 0" if self.source.half or not kept.all() else "contact"
        pane = Pane(title, outside(self.source.cells[kept]), *Seen.CUT)
        if self.contact is None:
            pane.toward, pane.share = Seen.SIDE
        else:
            on_bar = behind(self.contact) if title != "contact" else True
            pane.on_bodies = self.contact.cells[on_bar & (self.contact.body == BAR)]
        return pane

    def of_surfaces(self):
        """Each contact surface by itself, since one hides the other."""
        cells, body = self.source.cells, self.source.body
        sides = ((BAR, "bar from above", Seen.ABOVE), (DISK, "disk from below", Seen.BELOW))
        return [
            Pane(f"surface of the {name}", cells[body == of], *seen) for of, name, seen in sides if np.any(body == of)
        ]

    def scale_to(self, records):
        """Fixes colours, magnifications and cameras, to be the same in the pictures of all ``records``."""
        bounds = Bounds()
        for record in records:
            frame = self.source.frame(record, self.quantity)
            bounds.value = max(bounds.value, frame.values.max())
            bounds.deformation = max(bounds.deformation, np.linalg.norm(frame.deformation, axis=1).max())
            bounds.low = np.minimum(bounds.low, frame.placed.min(axis=0))
            bounds.high = np.maximum(bounds.high, frame.placed.max(axis=0))
            if self.contact is not None:
                bounds.take(self.tractions(record), self.contact)
        if self.source.half:
            bounds.low[1] = -bounds.high[1]
        self.bounds, (self.top, _) = bounds, scale(bounds.value)
        for pane, share in zip(self.panes, self.shares, strict=False):
            pane.fix(bounds, share / self.rows[2])
            if self.contact is not None and not pane.whole:
                faces = pane.faces if pane.on_bodies is None else pane.on_bodies
                pane.arrows = thinned(self.contact, faces, APART * pane.span)

    def tractions(self, record):
        """Those at the time of a record."""
        contact = self.contact
        near = record if contact is self.source else contact.records.nearest(self.source.times[record])
        return tractions(contact, near, self.of_arrows)

    def picture(self, record):
        """The picture of a record, after :meth:`scale_to`: an array of the shape (height, width, 3)."""
        first = self.plotter is None
        if first:
            self.begin()
        frame = self.source.frame(record, self.quantity)
        # milliseconds, to a microsecond
        when = f"t = {1e3 * self.source.times[record]:.3f} ms"
        self.plotter.subplot(0, 0)
        self.text(f"{when}    {self.title}".rstrip(), 0.012, 0.25, 0.46 * HEADING, name="heading")
        found = None if self.contact is None else self.tractions(record)
        keys = {}
        for column, pane in enumerate(self.panes):
            self.plotter.subplot(2, column)
            keys |= {key[0]: key for key in self.draw(pane, frame, found)}
            self.aim(pane, frame, found)
        if first:
            self.keys(list(keys.values()))
        with quiet():
            if not first:
                self.plotter.render()
            return self.plotter.screenshot(return_img=True)[:, :, :3]

    def begin(self):
        """Opens the window, off screen, with what is the same in all pictures."""
        pyvista = optional("pyvista", "render")
        count = len(self.panes)
        rows = [(0, slice(None)), (3, slice(None))]
        layout = {"shape": (4, count), "row_weights": self.rows, "col_weights": self.shares[:count]}
        with quiet():
            self.plotter = pyvista.Plotter(
                off_screen=True, window_size=self.size, border=False, lighting="none", groups=rows, **layout
            )
        self.plotter.set_background("white", all_renderers=True)
        for column, pane in enumerate(self.panes):
            self.plotter.subplot(1, column)
            self.titles(pane, column)
            self.plotter.subplot(2, column)
            light = pyvista.Light(position=(-0.25, -1.0, 0.8), focal_point=(0.0, 0.0, 0.0), light_type="scene light")
            self.plotter.add_light(light, only_active=True)
            self.ruler(pane, self.shares[column] / self.rows[2])
            self.plotter.add_axes(color=INK, line_width=3, viewport=(1.0 - 0.11 / self.shares[column], 0.0, 1.0, 0.25))

    def titles(self, pane, column):
        """The title of a view, and below what is drawn on it."""
        lines = [pane.title]
        if pane.deforms:
            lines[0] += ", deformation " + ("as it is" if pane.magnify == 1 else f"× {pane.magnify:g}")
        if pane.lift:
            lines[0] += f", disk lifted {1e3 * pane.lift:.2g} mm"
        if pane.arrows is not None and self.bounds.arrow > 0:
            what, unit = ("slip velocity", "m/s") if self.of_arrows == "slip_velocity" else ("shear", "MPa")
            length = self.bounds.arrow * (1.0 if unit == "m/s" else 1e-6)
            on = " on the bar" if pane.on_bodies is not None else ""
            meaning = "; white: stick, black: slip" if self.contact.has("state") else ""
            lines.append(f"arrows: {what}{on}, longest {length:.3g} {unit}{meaning}")
        for line, height in zip(lines, (0.58, 0.12), strict=False):
            self.text(line, 0.012 / self.shares[column], height, 0.31 * TITLES)

    def text(self, text, x, y, size, name=None):
        """Puts text at a place of the view (0 to 1), so high over the width of the picture."""
        looks = {"color": INK, "font_file": font(), "name": name}
        actor = self.plotter.add_text(text, position=(x, y), viewport=True, render=False, **looks)
        actor.prop.font_size = max(5, round(size * self.width))

    def draw(self, pane, frame, found):
        """Draws a view of a record; returns what the colours show, by the label of their bar."""
        surfaces = self.source.what == "contact"
        points = frame.magnified(pane.magnify)
        points[self.source.disk] += (0.0, 0.0, pane.lift)
        mesh = surface(points, pane.faces, frame.values, pane.mirrored)
        keys = [(QUANTITIES[self.quantity][2], COLOURS[self.source.what], self.top)]
        self.add(mesh, f"bodies {pane.title}", keys[0], show_edges=True, lighting=not surfaces)
        if pane.arrows is None:
            return keys
        if pane.on_bodies is not None:
            # towards the camera, which does not show, to lie on the bodies also where these are coarser
            points = found.frame.magnified(pane.magnify) - 0.3 * pane.span * pane.towards
            patch = surface(points, pane.on_bodies, found.pressure).clip_scalar(
                scalars="value", value=EDGE * self.bounds.pressure, invert=False
            )
            keys.append(("pressure on the bar (MPa)", COLOURS["contact"], scale(self.bounds.pressure)[0]))
            self.add(patch, f"patch {pane.title}", keys[1], lighting=False)
        self.draw_arrows(pane, points - 0.1 * pane.span * pane.towards, found)
        return keys

    def add(self, mesh, name, key, **looks):
        """Draws a surface in the place of that of the last record; without contact there is none."""
        self.plotter.remove_actor(name, reset_camera=False, render=False)
        if not mesh.n_cells:
            return
        edges = {"edge_color": LINES, "edge_opacity": 0.22, "line_width": max(1.0, self.width / 1600)}
        light = {"ambient": 0.55, "diffuse": 0.58, "specular": 0.0}
        self.plotter.add_mesh(
            mesh, name=name, scalars="value", cmap=colours(*key[1]), clim=(0.0, key[2]), show_scalar_bar=False,
            reset_camera=False, render=False, **edges, **light, **looks,
        )  # fmt: skip

    def draw_arrows(self, pane, points, found):
        """Draws the arrows of a view, white where the nodes stick and black where they slip."""
        pyvista = optional("pyvista", "render")
        nodes = pane.arrows[found.loaded(self.bounds.pressure)[pane.arrows]]
        for chosen, colour in ((found.sticks, "white"), (~found.sticks, "black")):
            name = f"{colour} {pane.title}"
            mine = nodes[chosen[nodes] & (np.linalg.norm(found.arrows[nodes], axis=1) > 0.02 * self.bounds.arrow)]
            self.plotter.remove_actor(name, reset_camera=False, render=False)
            if len(mine) and self.bounds.arrow > 0:
                cloud = pyvista.PolyData(points[mine])
                cloud["arrow"] = found.arrows[mine] * (ARROW * pane.span / self.bounds.arrow)
                shape = pyvista.Arrow(tip_length=0.35, tip_radius=0.14, shaft_radius=0.06, tip_resolution=16)
                arrows = cloud.glyph(orient="arrow", scale="arrow", geom=shape)
                self.plotter.add_mesh(arrows, name=name, color=colour, lighting=False, reset_camera=False, render=False)

    def aim(self, pane, frame, found):
        """Puts the camera of a view where it follows the contact."""
        if pane.whole:
            centre = pane.centre
        elif self.source.what == "fields":
            centre = frame.lowest + (0.0, 0.0, 0.5 * pane.lift)
        else:  # the middle of the pressure, or without contact of the surface
            nodes = np.unique(pane.faces)
            pressure = found.pressure[nodes]
            weights = pressure if pressure.sum() > 0 else None
            centre = np.average(frame.placed[nodes], axis=0, weights=weights)
        reach = 2.0 * max(pane.span, np.linalg.norm(self.bounds.high - self.bounds.low))
        camera = self.plotter.camera
        camera.parallel_projection, camera.up = True, (0.0, 0.0, 1.0)
        camera.focal_point, camera.position = centre, centre - reach * pane.towards
        camera.parallel_scale, camera.clipping_range = 0.5 * pane.span, (0.1 * reach, 3.0 * reach)

    def keys(self, keys):
        """The colour bars."""
        self.plotter.subplot(3, 0)
        wide, middles = (0.4, (0.27, 0.75)) if len(keys) > 1 else (0.5, (0.5,))
        pyvista = optional("pyvista", "render")
        for (label, map_, top), middle in zip(keys, middles, strict=True):
            mapper = pyvista.DataSetMapper()
            mapper.lookup_table = pyvista.LookupTable(cmap=colours(*map_), scalar_range=(0.0, top))
            bar = self.plotter.add_scalar_bar(
                label, mapper=mapper, n_labels=scale(top)[1] + 1, fmt="{:g}", color=INK, width=wide, height=0.62,
                position_x=middle - 0.5 * wide, position_y=0.3, unconstrained_font_size=True, render=False,
            )  # fmt: skip
            bar.SetTextPositionToPrecedeScalarBar()
            bar.SetVerticalTitleSeparation(round(0.005 * self.width))
            for letters, size in ((bar.GetTitleTextProperty(), 0.0125), (bar.GetLabelTextProperty(), 0.011)):
                letters.SetFontFamily(4)  # of a file
                letters.SetFontFile(font())
                letters.SetFontSize(round(size * self.width))

    def ruler(self, pane, aspect):
        """A bar of a round length in the lower left corner of a view."""
        pyvista = optional("pyvista", "render")
        length = rounded(0.25 * pane.span * aspect, down=True)
        share = length / (pane.span * aspect)
        ends = np.array([(0.03, 0.05), (0.03, 0.05), (0.03 + share, 0.05), (0.03 + share, 0.05)])
        ends[[0, 3], 1] += 0.012
        lines = pyvista.lines_from_points(np.column_stack([ends, np.zeros(4)]))
        mapper = pyvista._vtk.vtkPolyDataMapper2D()
        mapper.SetInputData(lines)
        place = pyvista._vtk.vtkCoordinate()
        place.SetCoordinateSystemToNormalizedViewport()
        mapper.SetTransformCoordinate(place)
        actor = pyvista._vtk.vtkActor2D()
        actor.SetMapper(mapper)
        actor.GetProperty().SetColor(*pyvista.Color(INK).float_rgb)
        actor.GetProperty().SetLineWidth(max(1.0, self.width / 800))
        self.plotter.add_actor(actor, reset_camera=False, render=False)
        self.text(f"{1e3 * length:g} mm", 0.03, 0.07, 0.31 * TITLES)

    def close(self):
        """Closes the window."""
        if self.plotter is not None:
            self.plotter.close()


def surface(points, faces, values, mirrored=False):
    """Faces of the points as a mesh with the array ``value``, and, if asked for, their image at y = 0."""
    pyvista = optional("pyvista", "render")
    nodes, corners = np.unique(faces, return_inverse=True)
    corners, points, values = corners.reshape(-1, 4), points[nodes], values[nodes]
    if mirrored:
        corners = np.vstack([corners, corners[:, ::-1] + len(nodes)])
        points, values = np.vstack([points, points * (1.0, -1.0, 1.0)]), np.tile(values, 2)
    mesh = pyvista.PolyData.from_regular_faces(points, corners)
    mesh["value"] = values
    return mesh


def colours(name, start):
    """A colour map of Matplotlib from ``start`` (0 to 1) on."""
    matplotlib = optional("matplotlib", "render")
    return matplotlib.colors.ListedColormap(matplotlib.colormaps[name](np.linspace(start, 1.0, 256)))


def font():
    """The file of DejaVu Sans, which has all signs of the labels and comes with Matplotlib."""
    return str(Path(optional("matplotlib", "render").get_data_path()) / "fonts" / "ttf" / "DejaVuSans.ttf")


@contextlib.contextmanager
def quiet():
    """VTK tries a display before it draws without one, and would say so."""
    logger = optional("pyvista", "render")._vtk.vtkLogger
    before = logger.GetCurrentVerbosityCutoff()
    logger.SetStderrVerbosity(logger.VERBOSITY_OFF)
    try:
        yield
    finally:
        logger.SetStderrVerbosity(before)
