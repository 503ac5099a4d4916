"""The table of actions: what every menu entry and button is called, its keys and its icon. No logic is here."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class ActionSpec:
    """One row of the table.

    Attributes
    ----------
    id : str
        What the code calls it.
    menu : str
        The menu it stands in; "" for none.
    text : str
    keys : tuple of str
        The first one is shown.
    icon : str
    checkable : bool
    group : str
        Of a group exactly one is checked.
    tip : str
        Told in the tooltip before the keys; the text itself when empty.
    """

    id: str
    menu: str
    text: str
    keys: tuple[str, ...] = ()
    icon: str = ""
    checkable: bool = False
    group: str = ""
    tip: str = ""


def _line(menu: str) -> ActionSpec:
    return ActionSpec("", menu, "")


ACTIONS: tuple[ActionSpec, ...] = (
    ActionSpec("file.new", "File", "New", ("Ctrl+N",), "new"),
    ActionSpec("file.open", "File", "Open…", ("Ctrl+O",), "open"),
    ActionSpec("file.recent", "File", "Open Recent"),
    _line("File"),
    ActionSpec("file.save", "File", "Save", ("Ctrl+S",), "save"),
    ActionSpec("file.save_as", "File", "Save As…", ("Ctrl+Shift+S",)),
    ActionSpec("file.revert", "File", "Revert to Saved", tip="Take what is in the file; undo takes it back"),
    ActionSpec("file.backup", "File", "Restore Backup", tip="Take the version before the last save"),
    ActionSpec("file.recover", "File", "Recover Unsaved Work…", tip="What was not saved when Inkbetween ended"),
    _line("File"),
    ActionSpec("file.stage", "File", "Stage…", (), "settings", tip="Size and colour of the paper"),
    ActionSpec(
        "file.import",
        "File",
        "Import SVG…",
        ("Ctrl+I",),
        tip="Make an SVG drawing the keyframe at the playhead, in one style",
    ),
    ActionSpec(
        "file.import_layers",
        "File",
        "Import SVG as Layers…",
        ("Ctrl+Shift+I",),
        tip="Add an SVG drawing as new layers, one for each style, with a keyframe at the playhead",
    ),
    ActionSpec(
        "file.import_folder",
        "File",
        "Import Folder of SVG…",
        (),
        tip="Add a layer whose keyframes are the SVG drawings of a folder, in the order of their names",
    ),
    ActionSpec(
        "file.import_lottie",
        "File",
        "Import Lottie…",
        (),
        tip="Add the shape layers of a Lottie animation with their keyframes",
    ),
    ActionSpec("file.export", "File", "Export…", ("Ctrl+E",), "export"),
    _line("File"),
    ActionSpec("file.close", "File", "Close", ("Ctrl+W",)),
    ActionSpec("file.quit", "File", "Quit", ("Ctrl+Q",)),
    ActionSpec("edit.undo", "Edit", "Undo", ("Ctrl+Z",), "undo"),
    ActionSpec("edit.redo", "Edit", "Redo", ("Ctrl+Shift+Z", "Ctrl+Y"), "redo"),
    _line("Edit"),
    ActionSpec("edit.cut", "Edit", "Cut", ("Ctrl+X",)),
    ActionSpec("edit.copy", "Edit", "Copy", ("Ctrl+C",), "copy"),
    ActionSpec(
        "edit.copy_picture",
        "Edit",
        "Copy Frame as Picture",
        ("Ctrl+Shift+C",),
        tip="Copy what is shown at the playhead for other programs, as large as the stage",
    ),
    ActionSpec(
        "edit.copy_svg",
        "Edit",
        "Copy Frame as SVG",
        ("Ctrl+Alt+C",),
        tip="Copy what is shown at the playhead as shapes for a drawing program",
    ),
    ActionSpec("edit.paste", "Edit", "Paste", ("Ctrl+V",)),
    ActionSpec("edit.delete", "Edit", "Delete", ("Delete",), "delete", tip="Take away what is selected"),
    _line("Edit"),
    ActionSpec("edit.select_all", "Edit", "Select All", ("Ctrl+A",)),
    ActionSpec("edit.select_none", "Edit", "Select None", ("Ctrl+Shift+A",)),
    _line("Edit"),
    ActionSpec("edit.shortcuts", "Edit", "Shortcuts…", tip="Choose the keys of another program, or your own"),
    ActionSpec("view.overlaid", "View", "Overlaid", ("1",), "overlay", checkable=True, group="arrangement"),
    ActionSpec("view.side", "View", "Side by Side", ("2",), "side-by-side", checkable=True, group="arrangement"),
    ActionSpec(
        "view.compare",
        "View",
        "Compare Methods",
        ("3",),
        "compare",
        checkable=True,
        group="arrangement",
        tip="Linear and intrinsic beside each other, at t = 0, 0.2 ... 1",
    ),
    _line("View"),
    ActionSpec("view.onion", "View", "Onion Skin", ("O",), "onion", checkable=True),
    ActionSpec(
        "view.lines", "View", "Next Kind of Lines", ("L",), tip="Lines of the correspondence: all, anchors, none"
    ),
    ActionSpec(
        "view.hues",
        "View",
        "Colour by Correspondence",
        ("H",),
        checkable=True,
        tip="Matching parts of the two outlines get the same colour",
    ),
    ActionSpec(
        "view.heat",
        "View",
        "Stretch Heat Map",
        ("Shift+H",),
        checkable=True,
        tip="Colour the in-between where it is longer or shorter than its keyframes, inside and outline",
    ),
    ActionSpec(
        "view.paths",
        "View",
        "Vertex Paths",
        checkable=True,
        tip="The ways of some vertices through the span, with a dot a frame",
    ),
    ActionSpec(
        "view.sheet",
        "View",
        "Exposure Sheet",
        ("X", "Ctrl+Shift+X"),
        checkable=True,
        tip="The film as a table of frames and layers, in which drawings are held, moved and taken out",
    ),
    ActionSpec(
        "view.final", "View", "Final Look", ("F9",), "visible", checkable=True, tip="As exported, without helpers"
    ),
    _line("View"),
    ActionSpec("view.fit", "View", "Fit Stage", ("F",), "fit"),
    ActionSpec("view.fit_film", "View", "Fit Film in Timeline", ("Shift+F",)),
    ActionSpec("view.zoom_in", "View", "Zoom In", ("Ctrl++", "Ctrl+=")),
    ActionSpec("view.zoom_out", "View", "Zoom Out", ("Ctrl+-",)),
    ActionSpec("view.actual", "View", "Actual Size", ("Ctrl+0",)),
    _line("View"),
    ActionSpec("view.theme_system", "View", "Theme of the System", (), "", checkable=True, group="theme"),
    ActionSpec("view.theme_light", "View", "Light Theme", (), "", checkable=True, group="theme"),
    ActionSpec("view.theme_dark", "View", "Dark Theme", (), "", checkable=True, group="theme"),
    ActionSpec("tool.select", "Draw", "Select", ("V",), "select", checkable=True, group="tool"),
    ActionSpec("tool.pen", "Draw", "Pen", ("P",), "pen", checkable=True, group="tool"),
    ActionSpec("tool.pencil", "Draw", "Pencil", ("B",), "pencil", checkable=True, group="tool"),
    ActionSpec("tool.correspond", "Draw", "Correspond", ("C",), "correspond", checkable=True, group="tool"),
    ActionSpec("tool.pin", "Draw", "Pin", ("K",), "pin", checkable=True, group="tool"),
    _line("Draw"),
    ActionSpec(
        "key.add",
        "Draw",
        "Add Keyframe Here",
        ("F6",),
        "add",
        tip="Make a keyframe of what is shown at the playhead: a breakdown, or a copy of the drawing that holds",
    ),
    ActionSpec(
        "key.copy",
        "Draw",
        "Copy Drawing to Other Keyframe",
        ("Ctrl+D",),
        tip="Put a copy of the drawing into the other keyframe of the span, or on the last frame if there is none",
    ),
    ActionSpec(
        "key.delete",
        "Draw",
        "Delete Keyframe",
        ("Shift+F6",),
        tip="Take away the selected keyframes, else the one at the playhead",
    ),
    _line("Draw"),
    ActionSpec(
        "key.duplicate",
        "Draw",
        "Duplicate Keyframes",
        tip="Put copies behind the selected keyframes",
    ),
    ActionSpec(
        "key.hold",
        "Draw",
        "Hold Until Next Keyframe",
        checkable=True,
        tip="No in-betweens: the drawing stays until the next keyframe",
    ),
    ActionSpec(
        "key.smooth",
        "Draw",
        "Smooth Through Keyframe",
        checkable=True,
        tip="The motion goes through the keyframe without a jump in its velocity",
    ),
    _line("Draw"),
    ActionSpec(
        "frame.insert", "Draw", "Insert Frame", ("F5",), tip="In this layer: what is shown is held a frame longer"
    ),
    ActionSpec(
        "frame.remove", "Draw", "Remove Frame", ("Shift+F5",), tip="In this layer: what is behind comes earlier"
    ),
    ActionSpec("frame.insert_all", "Draw", "Insert Frame in All Layers", ("Ctrl+F5",)),
    ActionSpec("frame.remove_all", "Draw", "Remove Frame from All Layers", ("Ctrl+Shift+F5",)),
    ActionSpec("layer.add", "Layer", "Add Layer", ("Ctrl+Shift+N",), "add", tip="Add a layer in front"),
    ActionSpec("layer.rename", "Layer", "Rename Layer"),
    ActionSpec("layer.duplicate", "Layer", "Duplicate Layer"),
    ActionSpec("layer.delete", "Layer", "Delete Layer"),
    _line("Layer"),
    ActionSpec("layer.show", "Layer", "Show Layer", checkable=True),
    ActionSpec("layer.lock", "Layer", "Lock Layer", checkable=True, tip="The layer is seen, but not changed"),
    ActionSpec("layer.solo", "Layer", "Solo Layer", checkable=True, tip="Show this layer alone"),
    ActionSpec(
        "key.smooth_layer",
        "Draw",
        "Smooth Layer",
        tip="Let the motion go through all keyframes of the layer without a jump in its velocity",
    ),
    ActionSpec(
        "key.sharp_layer", "Draw", "Sharp Layer", tip="Let every span of the layer start and end on its own"
    ),
    ActionSpec(
        "insert.letters",
        "Insert",
        "Letters…",
        ("T",),
        tip="Add the outlines of a text to the drawing at the playhead",
    ),
    ActionSpec(
        "insert.reference",
        "Insert",
        "Reference Picture…",
        tip="Lay a picture under the stage to draw over; it is never exported",
    ),
    ActionSpec("insert.no_reference", "Insert", "Remove Reference Picture"),
    ActionSpec("span.linear", "Span", "Linear", (), "", checkable=True, group="method"),
    ActionSpec("span.intrinsic", "Span", "Intrinsic", (), "", checkable=True, group="method"),
    ActionSpec("span.rigid", "Span", "Rigid", (), "", checkable=True, group="method"),
    ActionSpec("span.auto", "Span", "Auto", (), "", checkable=True, group="method"),
    ActionSpec(
        "span.other_way",
        "Span",
        "Turn the Other Way Round",
        (),
        "",
        tip="Go round the other side, left in place of right; again: back. Not for linear",
    ),
    _line("Span"),
    ActionSpec("span.clear", "Span", "Clear Anchors"),
    ActionSpec("span.clear_pins", "Span", "Clear Pins"),
    ActionSpec(
        "span.again", "Span", "Solve Again", tip="Forget the stored or chosen correspondence; anchors stay"
    ),
    ActionSpec(
        "span.flip", "Span", "Flip Direction", ("Shift+D",), tip="Let the correspondence run the other way round"
    ),
    ActionSpec(
        "span.shift_on",
        "Span",
        "Shift Start Forward",
        ("]",),
        tip="The start goes to the next vertex after",
    ),
    ActionSpec(
        "span.shift_back", "Span", "Shift Start Back", ("[",), tip="The start goes to the vertex before it"
    ),
    ActionSpec("play.toggle", "Play", "Play", ("Space",), "play"),
    ActionSpec("play.loop", "Play", "Loop", (), "loop", checkable=True),
    ActionSpec("play.ping_pong", "Play", "Ping-Pong", (), "ping-pong", checkable=True, tip="Play forth and back"),
    ActionSpec("play.range_from", "Play", "Play from This Frame"),
    ActionSpec("play.range_to", "Play", "Play to This Frame"),
    ActionSpec("play.no_range", "Play", "Play the Whole Film"),
    _line("Play"),
    ActionSpec("play.previous", "Play", "Previous Frame", (",", "Left"), "previous"),
    ActionSpec("play.next", "Play", "Next Frame", (".", "Right"), "next"),
    ActionSpec("play.previous_key", "Play", "Previous Keyframe", ("Ctrl+,",)),
    ActionSpec("play.next_key", "Play", "Next Keyframe", ("Ctrl+.",)),
    ActionSpec("play.first", "Play", "First Frame", ("Home",), "first"),
    ActionSpec("play.last", "Play", "Last Frame", ("End",), "last"),
    _line("Play"),
    ActionSpec(
        "flip.previous", "Play", "Flip to Previous Drawing", ("A",), tip="Shown as long as the key is held"
    ),
    ActionSpec("flip.next", "Play", "Flip to Next Drawing", ("D",), tip="Shown as long as the key is held"),
    ActionSpec("help.find", "Help", "Find Command…", ("Ctrl+K",), tip="Run any command by a part of its name"),
    ActionSpec("help.keys", "Help", "Keys and Mouse", ("F1",), tip="Show every key over the window"),
    ActionSpec("help.tour", "Help", "Tour", tip="Draw, correspond, scrub and export in a minute"),
    _line("Help"),
    ActionSpec("help.about", "Help", "About Inkbetween"),
)
MENUS = ("File", "Edit", "View", "Draw", "Insert", "Layer", "Span", "Play", "Samples", "Help")
