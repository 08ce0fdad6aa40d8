/* SPDX-License-Identifier: MIT */
#include "x_window.h"

#include "require.h"

#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <X11/keysym.h>
#include <stdlib.h>

static bool is_ours(Display *display, Window window)
{
    char *name = NULL;
    const bool ours = XFetchName(display, window, &name) && name && strncmp(name, "sdfgi", 5) == 0;
    if (name)
        XFree(name);
    return ours;
}

static Window find_window(Display *display)
{
    Window root, parent, *windows = NULL, found = 0;
    unsigned count = 0;
    XQueryTree(display, DefaultRootWindow(display), &root, &parent, &windows, &count);
    for (unsigned i = 0; i < count; i++)
        if (is_ours(display, windows[i]))
            found = windows[i];
    if (windows)
        XFree(windows);
    return found;
}

void x_window_open(struct x_window *x)
{
    Display *display = XOpenDisplay(NULL);
    REQUIRE_TRUE(display != NULL);
    *x = (struct x_window){ display, find_window(display), 1000 };
    REQUIRE_TRUE(x->window != 0);
}

void x_window_close(struct x_window *x)
{
    XCloseDisplay(x->display);
}

static const struct {
    KeySym symbol;
    unsigned modifiers;
} keys[] = {
    [X_KEY_F1] = { XK_F1, 0 }, [X_KEY_F2] = { XK_F2, 0 },
    [X_KEY_V] = { XK_v, 0 },   [X_KEY_SHIFT_V] = { XK_v, ShiftMask },
    [X_KEY_0] = { XK_0, 0 },   [X_KEY_3] = { XK_3, 0 },
    [X_KEY_G] = { XK_g, 0 },   [X_KEY_ESCAPE] = { XK_Escape, 0 },
};

static void send(struct x_window *x, XEvent *event, long mask)
{
    XSendEvent(x->display, x->window, True, mask, event);
    XSync(x->display, False);
}

void x_window_press(struct x_window *x, enum x_key key)
{
    XEvent event = { .xkey = { .display = x->display,
                               .window = x->window,
                               .root = DefaultRootWindow((Display *)x->display),
                               .same_screen = True,
                               .state = keys[key].modifiers,
                               .keycode = XKeysymToKeycode(x->display, keys[key].symbol) } };
    for (int i = 0; i < 2; i++) {
        event.xkey.type = i == 0 ? KeyPress : KeyRelease;
        event.xkey.time = x->time += 50;
        send(x, &event, i == 0 ? KeyPressMask : KeyReleaseMask);
    }
}

void x_window_point(struct x_window *x, float at_x, float at_y)
{
    XWarpPointer(x->display, None, x->window, 0, 0, 0, 0, (int)at_x, (int)at_y);
    XSync(x->display, False);
}

static void button(struct x_window *x, unsigned number, bool down)
{
    XEvent event = { .xbutton = { .type = down ? ButtonPress : ButtonRelease,
                                  .display = x->display,
                                  .window = x->window,
                                  .root = DefaultRootWindow((Display *)x->display),
                                  .same_screen = True,
                                  .button = number,
                                  .time = x->time += 50 } };
    send(x, &event, down ? ButtonPressMask : ButtonReleaseMask);
}

void x_window_button(struct x_window *x, bool down)
{
    button(x, Button1, down);
}

void x_window_wheel(struct x_window *x)
{
    button(x, Button5, true);
    button(x, Button5, false);
}

struct x_picture x_window_capture(struct x_window *x)
{
    XWindowAttributes attributes;
    REQUIRE_TRUE(XGetWindowAttributes(x->display, x->window, &attributes) != 0);
    XImage *image = XGetImage(x->display, x->window, 0, 0, (unsigned)attributes.width,
                              (unsigned)attributes.height, AllPlanes, ZPixmap);
    REQUIRE_TRUE(image != NULL);
    struct x_picture picture = { (uint32_t)image->width, (uint32_t)image->height, NULL };
    picture.pixels = malloc(sizeof *picture.pixels * picture.width * picture.height);
    REQUIRE_TRUE(picture.pixels != NULL);
    for (uint32_t i = 0; i < picture.width * picture.height; i++)
        picture.pixels[i] =
            (uint32_t)XGetPixel(image, (int)(i % picture.width), (int)(i / picture.width)) & 0xffffff;
    XDestroyImage(image);
    return picture;
}

double x_picture_differ(const struct x_picture *a, const struct x_picture *b, uint32_t from, uint32_t to)
{
    uint32_t differ = 0;
    REQUIRE_CMP(a->width, ==, b->width);
    REQUIRE_CMP(a->height, ==, b->height);
    for (uint32_t y = 0; y < a->height; y++)
        for (uint32_t i = y * a->width + from; i < y * a->width + to; i++)
            differ += a->pixels[i] != b->pixels[i];
    return (double)differ / ((double)a->height * (to - from));
}
