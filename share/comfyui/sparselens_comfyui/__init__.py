"""A node of ComfyUI that blurs a picture by its estimated depth. Copy this folder into ComfyUI's custom_nodes, and put
the wheel of sparselens into ComfyUI's Python: pip install sparselens-VERSION-cp3*.whl

The tests run it with stand-ins for ComfyUI and torch. It was not tried in ComfyUI."""
import warnings

import numpy
import sparselens
import torch

FARTHEST = 1e-3  # white less this share of black and white: a disparity of 0 would be infinitely far


def linear(encoded):
    """Light of sRGB values."""
    return numpy.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)


def encoded(light):
    light = numpy.clip(light, 0, 1)
    return numpy.where(light <= 0.0031308, light * 12.92, 1.055 * light ** (1 / 2.4) - 0.055)


def blurred(image, disparity, blur, x, y, gain):
    """The picture, sRGB (height, width, 3), through a lens: the CoC of a pixel is `blur` times the difference of its
    disparity (0 to 1, near is white) and that at (x, y), shares of the width and height."""
    height, width = disparity.shape
    if image.shape[:2] != (height, width):
        raise ValueError("the depth has %d x %d pixels, the picture %d x %d: scale the depth (Upscale Image)"
                         % (width, height, image.shape[1], image.shape[0]))
    if not blur:
        return image
    # With a film as wide as the focal length is long, a radius of blur / width scene units has CoCs of blur pixels.
    depth = (1 / numpy.maximum(disparity, FARTHEST)).astype(numpy.float32)
    row, column = min(int(y * height), height - 1), min(int(x * width), width - 1)
    view = sparselens.View(linear(image).astype(numpy.float32), depth, channels=["R", "G", "B"], position=(0, 0),
                           focal_length=36, sensor_width=36, lens_radius=blur / width,
                           focus_distance=float(depth[row, column]))
    with warnings.catch_warnings():  # those of renders: a photograph has soft edges
        warnings.simplefilter("ignore")
        picture = sparselens.gather(sparselens.warp([view]), overscan="keep",
                                    **({"highlight_gain": gain} if gain > 1 else {}))
    return encoded(picture.pixels[:, :, :3])


class DepthOfField:
    CATEGORY = "image/postprocessing"
    FUNCTION = "take"
    RETURN_TYPES = ("IMAGE",)
    DESCRIPTION = "Depth of field of a picture with estimated depth, near is white (Depth Anything, MiDaS)."

    @classmethod
    def INPUT_TYPES(cls):
        share = {"min": 0.0, "max": 1.0, "step": 0.01}
        return {"required": {
            "image": ("IMAGE",),
            "depth": ("IMAGE",),
            "blur": ("FLOAT", {"default": 20.0, "min": 0.0, "max": 500.0, "step": 0.5,
                               "tooltip": "radius in pixels of the disc of white if black is in focus"}),
            "focus_x": ("FLOAT", {"default": 0.5, "tooltip": "place in focus: share of the width", **share}),
            "focus_y": ("FLOAT", {"default": 0.5, "tooltip": "share of the height, from the top", **share}),
            "highlight_gain": ("FLOAT", {"default": 1.0, "min": 1.0, "max": 100.0, "step": 0.5,
                                         "tooltip": "factor by which clipped lights become brighter"}),
        }}

    def take(self, image, depth, blur, focus_x, focus_y, highlight_gain):
        """One picture after the other; a single depth serves all. Some nodes give depths without channels: (n, height,
        width), or (height, width)."""
        pictures, depths = image.cpu().numpy(), depth.cpu().numpy()
        if depths.ndim < 4:
            depths = depths.reshape(-1, *depths.shape[-2:], 1)
        if len(depths) not in (1, len(pictures)):
            raise ValueError("%d pictures and %d depths" % (len(pictures), len(depths)))
        taken = [blurred(picture[:, :, :3], depths[n % len(depths)][:, :, 0], blur, focus_x, focus_y, highlight_gain)
                 for n, picture in enumerate(pictures)]
        return (torch.from_numpy(numpy.stack(taken).astype(numpy.float32)),)


NODE_CLASS_MAPPINGS = {"SparseLensDepthOfField": DepthOfField}
NODE_DISPLAY_NAME_MAPPINGS = {"SparseLensDepthOfField": "Depth of Field (sparselens)"}
