"""Presses keys of the windows of an X server, as a keyboard does: Blender's own event_simulate() does not stop a render.
"""

import ctypes
import time

import bpy

SYMBOLS = {"Esc": 0xff1b, "Shift_L": 0xffe1}  # of keysymdef.h


class KeyEvent(ctypes.Structure):
    """XKeyEvent of Xlib.h, padded to the size of an XEvent."""

    _fields_ = ([("type", ctypes.c_int), ("serial", ctypes.c_ulong), ("send_event", ctypes.c_int),
                 ("display", ctypes.c_void_p)]
                + [(name, ctypes.c_ulong) for name in ("window", "root", "subwindow", "time")]
                + [(name, ctypes.c_int) for name in ("x", "y", "x_root", "y_root")]
                + [("state", ctypes.c_uint), ("keycode", ctypes.c_uint), ("same_screen", ctypes.c_int),
                   ("rest", ctypes.c_long * 24)])


def press_key(name):
    """Presses and releases the key in all windows."""
    x11, window = ctypes.CDLL("libX11.so.6"), ctypes.c_ulong
    for function in "XOpenDisplay", "XDefaultRootWindow":
        getattr(x11, function).restype = ctypes.c_void_p if function == "XOpenDisplay" else window
    display = ctypes.c_void_p(x11.XOpenDisplay(None))
    root, parent, children, count = window(), window(), ctypes.POINTER(window)(), ctypes.c_uint()
    x11.XQueryTree(display, window(x11.XDefaultRootWindow(display)), *[
        ctypes.byref(found) for found in (root, parent, children, count)])
    code = x11.XKeysymToKeycode(display, window(SYMBOLS[name]))
    for child in children[:count.value]:
        for kind in 2, 3:  # pressed, released
            event = KeyEvent(type=kind, display=display, window=child, root=root, keycode=code, same_screen=1)
            x11.XSendEvent(display, window(child), 0, 0, ctypes.byref(event))
    x11.XCloseDisplay(display)


def esc_at_end_of(render):
    """Presses Esc at the end of the render with this number, when it cannot be stopped any more. Blender is still in its
    thread, and takes the key."""
    left = [render]

    def press_esc(*_):
        left[0] -= 1
        if left[0] == 0:
            bpy.app.handlers.render_complete.remove(press_esc)
            press_key("Esc")
            time.sleep(1)

    bpy.app.handlers.render_complete.append(press_esc)
