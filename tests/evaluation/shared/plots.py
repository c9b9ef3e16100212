"""The frame of the plots that scripts draw as SVG."""

# Of one plot, and the margins of all, pixels.
WIDTH, HEIGHT, LEFT, TOP = 300, 190, 46, 16


def document(plots, legend, below=0):
    """Two plots side by side, with a legend; `below`: room below them for more."""
    width, height = LEFT + 2 * WIDTH + 100, TOP + HEIGHT + 48 + below
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}" '
            f'font-family="sans-serif" font-size="12">\n<rect width="100%" height="100%" fill="white"/>\n'
            + '\n'.join(plots) + '\n' + legend + '\n</svg>\n')
