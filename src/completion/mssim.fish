# Completion of mssim in fish, which mssim itself makes (mssim --complete).

function __mssim_complete
    set -l words (commandline -opc)
    set -l current (commandline -ct | string unescape)
    set -l mssim $words[1]
    set -e words[1]
    set -l lines ($mssim --complete $words "$current" 2>/dev/null)
    set -l first (string split \t -- $lines[1])
    set -e lines[1]
    string join -- \n $lines
    set -l name (string sub -s (math (string length -- "$first[2]") + 1) -- "$current")
    switch "$first[1]"
        case file
            # fish expands no ~ in quotes, and __fish_complete_path quotes the name.
            set -l home
            string match -q '~/*' -- "$name"
            and set home $HOME/
            and set name $home(string sub -s 3 -- "$name")
            set -l paths (__fish_complete_path "$name")
            test -n "$home"
            and set paths "~/"(string sub -s (math (string length -- "$home") + 1) -- $paths)
            string join -- \n "$first[2]"$paths
        case directory
            string join -- \n "$first[2]"(__fish_complete_directories "$name")
    end
end
complete -c mssim -f -a '(__mssim_complete)'
